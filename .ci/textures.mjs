// Cubes in KTX 2 and DDS files, as other programs see them: three.js reads our KTX 2, and a reader of its own, which
// shares no code with us, our DDS of half floats; their smaller copies, too. What they find is compared with the same faces in a TGA file.
//
//   node .ci/textures.mjs PROGRAM FOLDER_OF_THREE FOLDER_OF_FILAMENT
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [program, three, filament] = process.argv.slice(2).map((path) => resolve(path));
const load = (path) => import(pathToFileURL(join(three, path)));
const { DataUtils, HalfFloatType, RGBAFormat, SRGBColorSpace, UnsignedByteType } = await load("build/three.module.js");
const { KTX2Loader } = await load("examples/jsm/loaders/KTX2Loader.js");

const { read } = await load("examples/jsm/libs/ktx-parse.module.js");

const EDGE = 48;
/// 48, 24, 12, 6, 3, 1.
const LEVELS = 6;
const folder = mkdtempSync(join(tmpdir(), "textures-"));
const at = (name) => join(folder, name);
const bytes = (name) => new Uint8Array(readFileSync(at(name)));

/** Each face has colours of its own, and no two of its corners are alike. */
function drawFace(name, index) {
  const header = Buffer.from([0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, EDGE, 0, EDGE, 0, 24, 0x20]);
  const pixels = Array.from({ length: EDGE * EDGE }, (_, i) => [4 * (i % EDGE), 4 * Math.floor(i / EDGE), 40 * index]);
  writeFileSync(at(`${name}.tga`), Buffer.concat([header, Buffer.from(pixels.flat())]));
}

/** The pixels of a TGA file of 24 bits, run-length encoded or not, as RGB. */
function readTga(name) {
  const file = bytes(name);
  const [width, height] = [file[12] + 256 * file[13], file[14] + 256 * file[15]];
  assert.equal(file[16], 24);
  assert.equal(file[17] & 0x20, 0x20, "rows from the top");
  let position = 18 + file[0];
  const rgb = [];
  const pixel = (start) => rgb.push(file[start + 2], file[start + 1], file[start]);
  while (rgb.length < 3 * width * height) {
    const packet = file[2] === 10 ? file[position++] : 0;
    const count = (packet & 0x7f) + 1;
    for (let i = 0; i < count; i++) pixel(position + (packet & 0x80 ? 0 : 3 * i));
    position += packet & 0x80 ? 3 : 3 * count;
  }
  return { width, height, rgb };
}

async function readKtx2(name) {
  const { faceCount, levelCount, layerCount, pixelWidth, pixelHeight, keyValue, dataFormatDescriptor } =
    read(bytes(name));
  const levels = name.startsWith("mips") ? LEVELS : 1;
  assert.deepEqual([faceCount, levelCount, layerCount, pixelWidth, pixelHeight], [6, levels, 0, EDGE, EDGE]);
  assert.deepEqual(keyValue, { KTXorientation: "rd", KTXwriter: "cosmorama" });
  // Halves are premultiplied, by the flag of the descriptor; bytes are not.
  assert.equal(dataFormatDescriptor[0].flags & 1, Number(name.includes("half")));
  const loader = new KTX2Loader();
  // What a graphics card could decompress does not matter here.
  loader.workerConfig = {};
  const { buffer } = bytes(name);
  return new Promise((done, failed) => loader.parse(buffer, done, failed));
}

/** Texels of the six faces, one after the other: three.js lays all of a level's into one array. */
function faces(texture) {
  const { width, height, data } = texture.image;
  assert.deepEqual([width, height, data.length], [EDGE, EDGE, 6 * EDGE * EDGE * 4]);
  return data;
}

/** The halves of a DDS file, by the letter of Microsoft's reference. */
function readDds(name) {
  const file = bytes(name);
  const view = new DataView(file.buffer);
  const word = (offset) => view.getUint32(offset, true);
  assert.equal(String.fromCharCode(...file.slice(0, 4)), "DDS ");
  assert.deepEqual([word(4), word(12), word(16)], [124, EDGE, EDGE]);
  assert.equal(word(8) & 0x1007, 0x1007, "caps, height, width and pixel format");
  assert.equal(word(8) & 8, 8, "a pitch");
  assert.equal(word(20), 8 * EDGE);
  assert.deepEqual([word(76), word(80) & 4, String.fromCharCode(...file.slice(84, 88))], [32, 4, "DX10"]);
  assert.equal(word(108) & 0x1008, 0x1008, "a texture of several surfaces");
  assert.equal(word(112) & 0xfe00, 0xfe00, "a cube with all faces");
  // R16G16B16A16_FLOAT, of two dimensions, a cube, one of them, premultiplied.
  assert.deepEqual([word(128), word(132), word(136), word(140), word(144)], [10, 3, 4, 1, 2]);
  assert.equal(file.length, 148 + 6 * EDGE * EDGE * 8);
  return Array.from({ length: 6 * EDGE * EDGE * 4 }, (_, i) => view.getUint16(148 + 2 * i, true));
}

/** The same of a DDS file with smaller copies: each face is followed by its own. Level by level. */
function readDdsLevels(name) {
  const view = new DataView(bytes(name).buffer);
  assert.equal(view.getUint32(8, true) & 0x20000, 0x20000, "a count of levels");
  assert.deepEqual([view.getUint32(28, true), view.getUint32(108, true) & 0x401008], [LEVELS, 0x401008]);
  const levels = Array.from({ length: LEVELS }, () => []);
  let position = 148;
  for (let face = 0; face < 6; face++) {
    for (let level = 0; level < LEVELS; level++) {
      for (let i = 0; i < (EDGE >> level) ** 2 * 4; i++, position += 2) {
        levels[level].push(view.getUint16(position, true));
      }
    }
  }
  assert.equal(position, view.byteLength);
  return levels;
}

const convert = (name, ...options) => {
  const size = options.includes("--size") ? [] : ["--size", String(EDGE)];
  execFileSync(program, ["convert", at("{face}.tga"), at(name), ...size, ...options], { stdio: "pipe" });
};

const srgb = (light) => 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);

/** The smaller copies that a program sees are what the conversion makes at their sizes. */
function compareLevels(what, levels, allowed, code, options = []) {
  levels.forEach((found, level) => {
    const edge = EDGE >> level;
    convert(`level${level}.tga`, "--to", "cube:layout=strip-v,order=opengl", "--size", String(edge), "-y", ...options);
    const { width, rgb } = readTga(`level${level}.tga`);
    assert.deepEqual([width, found.length], [edge, 6 * edge * edge * 4], `${what}: level ${level}`);
    const differences = rgb.map((expected, i) => Math.abs(code(found[4 * Math.floor(i / 3) + (i % 3)]) - expected));
    const worst = differences.reduce((a, b) => Math.max(a, b), 0);
    assert.ok(worst <= allowed, `${what}: level ${level}: a difference of ${worst} codes`);
  });
  console.log(`${what}: ${levels.length} levels`);
}

function compare(what, found, expected, allowed, code) {
  let worst = 0;
  for (let pixel = 0; pixel < 6 * EDGE * EDGE; pixel++) {
    for (let c = 0; c < 3; c++) {
      worst = Math.max(worst, Math.abs(code(found[4 * pixel + c]) - expected[3 * pixel + c]));
    }
    assert.equal(Math.round(code(found[4 * pixel + 3])), 255, `${what}: pixel ${pixel} is opaque`);
  }
  assert.ok(worst <= allowed, `${what}: a difference of ${worst} codes`);
  console.log(`${what}: six faces of ${EDGE}x${EDGE}, largest difference ${worst.toFixed(3)} codes of 255`);
}

/** The colours, in codes, of the texel that three.js shows in a direction of a cube that it loads (WebGLMaterials.js negates x). */
function shown(cube, level, [x, y, z]) {
  const [faces, s, t] =
    Math.abs(x) > Math.max(Math.abs(y), Math.abs(z)) ? [x > 0 ? 1 : 0, z / x, -y / Math.abs(x)]
    : Math.abs(y) > Math.abs(z) ? [y > 0 ? 2 : 3, -x / Math.abs(y), z / y]
    : [z > 0 ? 4 : 5, -x / z, -y / Math.abs(z)];
  const { data, width } = cube.image[faces].mipmaps[level];
  const place = (at) => Math.floor(((at + 1) / 2) * width);
  const first = 4 * (place(t) * width + place(s));
  return [...data.slice(first, first + 3)].map((bits) => srgb(DataUtils.fromHalfFloat(bits)));
}

/** A folder for three.js: its module makes cubes that show each face where a panorama would, upright and not mirrored. */
async function checkFolder() {
  const sizes = ["--size", "64", "--sky-size", "64"];
  execFileSync(program, ["light", "deploy", at("{face}.tga"), at("three"), "--preset", "three", ...sizes], { stdio: "pipe" });
  const module = join(three, "../../light.mjs");
  copyFileSync(at("three/light.js"), module);
  const { cube, probe } = await import(pathToFileURL(module));
  const texture = async (name) => {
    const loader = new KTX2Loader();
    loader.workerConfig = {};
    return cube(await new Promise((done, failed) => loader.parse(bytes(name).buffer, done, failed)));
  };
  const [sky, chain] = [await texture("three/sky.ktx2"), await texture("three/specular.ktx2")];
  assert.deepEqual([sky, chain].map((made) => made.image[0].mipmaps.length), [7, 4]);
  assert.ok(sky.isCompressedCubeTexture && sky.type === HalfFloatType && sky.format === RGBAFormat);
  // The middle of a panorama is at +x, its right half towards +z.
  const axes = { front: [1, 0, 0], right: [0, 0, 1], back: [-1, 0, 0], left: [0, 0, -1], top: [0, 1, 0], bottom: [0, -1, 0] };
  const right = { front: [0, 0, 1], right: [-1, 0, 0], back: [0, 0, -1], left: [1, 0, 0], top: [0, 0, 1], bottom: [0, 0, 1] };
  Object.entries(axes).forEach(([name, axis], index) => {
    const [from, to] = [-0.5, 0.5].map((step) => shown(sky, 0, axis.map((part, k) => part + step * right[name][k])));
    assert.ok(Math.abs(from[0] - 40 * index) < 3 && Math.abs(to[0] - 40 * index) < 3, `${name}: ${from}, ${to}`);
    assert.ok(Math.abs(to[2] - from[2] - 2 * EDGE) < 6 && Math.abs(to[1] - from[1]) < 3, `${name}: ${from}, ${to}`);
  });
  // Roughness 1 is the light on matt surfaces, as nine coefficients have it, to what these miss.
  const light = probe(JSON.parse(readFileSync(at("three/probe.json"))));
  const { Vector3 } = await load("build/three.module.js");
  for (const axis of Object.values(axes)) {
    const irradiance = light.sh.getIrradianceAt(new Vector3(...axis), new Vector3());
    const matt = shown(chain, 3, axis).map((code) => Math.PI * (code <= 10.31475 ? code / 3294.6 : ((code / 255 + 0.055) / 1.055) ** 2.4));
    [irradiance.x, irradiance.y, irradiance.z].forEach((value, k) => assert.ok(Math.abs(value - matt[k]) < 0.1, `${axis}: ${value}, ${matt[k]}`));
  }
  console.log("light deploy --preset three: two cubes and a probe in three.js");
}

/** Filament's reader finds cubes of halves with their levels, and nine coefficients. */
async function checkFilament() {
  const sizes = ["--size", "64", "--sky-size", "64"];
  execFileSync(program, ["light", "deploy", at("{face}.tga"), at("hall"), "--preset", "filament", ...sizes], { stdio: "pipe" });
  const start = createRequire(import.meta.url)(join(filament, "filament.js"));
  const module = await start({ wasmBinary: readFileSync(join(filament, "filament.wasm")) });
  for (const [name, levels] of [["hall/hall_skybox.ktx", 7], ["hall/hall_ibl.ktx", 3]]) {
    const file = bytes(name);
    const buffer = new module.driver$BufferDescriptor(file.length);
    buffer.getBytes().set(file);
    const ktx = new module.Ktx1Bundle(buffer);
    assert.deepEqual([ktx.isCubemap(), ktx.getNumMipLevels()], [true, levels]);
    assert.equal(ktx.getInternalFormat(false), module.Texture$InternalFormat.RGBA16F);
    assert.equal(ktx.getPixelDataType(), module.PixelDataType.HALF);
    if (levels === 3) assert.equal(ktx.getMetadata("sh").trim().split(/\s+/).filter((text) => Number.isFinite(Number(text))).length, 27);
  }
  console.log("light deploy --preset filament: two cubes and harmonics in Filament");
}

try {
  ["front", "right", "back", "left", "top", "bottom"].forEach(drawFace);
  convert("strip.tga", "--to", "cube:layout=strip-v,order=opengl");
  // Pictures with alpha, as textures are, are filtered in floats, opaque ones in integers: a code may differ. Points have none to
  // round.
  const point = ["--filter", "point"];
  convert("points.tga", "--to", "cube:layout=strip-v,order=opengl", ...point);
  convert("eight.ktx2", "--to", "cube", ...point);
  convert("half.ktx2", "--to", "cube", "--depth", "half");
  convert("half.dds", "--to", "cube", "--depth", "half");
  const { width, height, rgb } = readTga("strip.tga");
  assert.deepEqual([width, height], [EDGE, 6 * EDGE]);

  const eight = await readKtx2("eight.ktx2");
  assert.deepEqual([eight.format, eight.type, eight.colorSpace], [RGBAFormat, UnsignedByteType, SRGBColorSpace]);
  compare("KTX 2, 8 bits, in three.js", faces(eight), readTga("points.tga").rgb, 0, (code) => code);

  const half = await readKtx2("half.ktx2");
  assert.deepEqual([half.format, half.type], [RGBAFormat, HalfFloatType]);
  const code = (bits) => srgb(DataUtils.fromHalfFloat(bits));
  compare("KTX 2, halves, in three.js", faces(half), rgb, 0.6, code);
  compare("DDS, halves, by the reference", readDds("half.dds"), rgb, 0.6, code);

  convert("mips.ktx2", "--to", "cube", "--mips", ...point);
  convert("mips-half.ktx2", "--to", "cube", "--mips", "--depth", "half");
  convert("mips-half.dds", "--to", "cube", "--mips", "--depth", "half");
  for (const [name, allowed, read, options] of [["mips.ktx2", 0, (code) => code, point], ["mips-half.ktx2", 0.6, code, []]]) {
    const texture = await readKtx2(name);
    compareLevels(`${name} in three.js`, texture.mipmaps.map((level) => level.data), allowed, read, options);
  }
  compareLevels("mips-half.dds by the reference", readDdsLevels("mips-half.dds"), 0.6, code);
  await checkFolder();
  await checkFilament();
} finally {
  rmSync(folder, { recursive: true });
}

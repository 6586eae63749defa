// Has three.js make its prefiltered chain (PMREM) from an .hdr panorama, in headless Chromium, whose graphics run on the CPU.
//
//     node benches/light_three.mjs MODULES SKY.hdr     prints JSON: {"seconds": CPU-s, "energies": [mean green of each level]}
//
// MODULES is a folder `node_modules` with `three` and `puppeteer-core`. Faces have 256 pixels, as many as cubes that are given to three.js
// have. Seconds are those of all of the browser's processes from the decoded panorama until a level can be read; the browser's start and the
// decoder are not counted.
import {readFileSync, readdirSync} from "node:fs";
import {createServer} from "node:http";
import {createRequire} from "node:module";
import {extname, join} from "node:path";

const [modules, sky] = process.argv.slice(2);
const puppeteer = createRequire(join(modules, "any.js"))("puppeteer-core");
const [EDGE, LEVELS] = [256, 5];

/** CPU-seconds so far of a process and all below it. Linux counts them in hundredths. */
function cpuSeconds(root) {
    const all = new Map();
    for (const pid of readdirSync("/proc").filter(name => /^\d+$/.test(name))) {
        try {
            const words = readFileSync(`/proc/${pid}/stat`, "latin1").replace(/^.*\) /s, "").split(" ");
            all.set(+pid, {parent: +words[1], ticks: +words[11] + +words[12]});
        } catch { /* It has ended meanwhile. */ }
    }
    const below = pid => pid === root || (all.has(pid) && below(all.get(pid).parent));
    return [...all].reduce((sum, [pid, {ticks}]) => sum + (below(pid) ? ticks : 0), 0) / 100;
}

const PAGE = `<!DOCTYPE html><script type="importmap">{"imports": {"three": "/three/build/three.module.js"}}</script>
<script type="module">
import * as THREE from "three";
import {HDRLoader} from "/three/examples/jsm/loaders/HDRLoader.js";
const renderer = new THREE.WebGLRenderer();
const sky = await new HDRLoader().setDataType(THREE.FloatType).loadAsync("/sky.hdr");
sky.mapping = THREE.EquirectangularReflectionMapping;

// Faces of one level, pixel by pixel.
const reader = new THREE.ShaderMaterial({
    uniforms: {chain: {value: null}, level: {value: 0}, across: {value: null}, up: {value: null}, ahead: {value: null}},
    vertexShader: "varying vec2 place; void main() { place = 2.0 * uv - 1.0; gl_Position = vec4(position, 1.0); }",
    fragmentShader: "uniform samplerCube chain; uniform float level; uniform vec3 across, up, ahead; varying vec2 place;" +
        "void main() { gl_FragColor = textureLod(chain, ahead + place.x * across + place.y * up, level); }",
});
const scene = new THREE.Scene().add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), reader));
const AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(axis => new THREE.Vector3(...axis));

/** Mean green of a level over the sphere, pixels by solid angle. */
function energy(chain, level) {
    const edge = chain.width >> level, texels = new Float32Array(4 * edge * edge);
    const face = new THREE.WebGLRenderTarget(edge, edge, {type: THREE.FloatType});
    let [sum, whole] = [0, 0];
    for (const axis of [0, 1, 2]) for (const sign of [1, -1]) {
        const [across, up] = [AXES[(axis + 1) % 3], AXES[(axis + 2) % 3]];
        const values = {chain: chain.texture, level, across, up, ahead: AXES[axis].clone().multiplyScalar(sign)};
        for (const [name, value] of Object.entries(values)) reader.uniforms[name].value = value;
        renderer.setRenderTarget(face);
        renderer.render(scene, new THREE.Camera());
        renderer.readRenderTargetPixels(face, 0, 0, edge, edge, texels);
        for (let k = 0; k < edge * edge; k++) {
            const [x, y] = [k % edge, Math.floor(k / edge)].map(at => (2 * at + 1) / edge - 1);
            const angle = (1 + x * x + y * y) ** -1.5;
            sum += angle * texels[4 * k + 1], whole += angle;
        }
    }
    return sum / whole;
}

window.make = edge => {
    const cube = new THREE.WebGLCubeRenderTarget(edge, {type: THREE.HalfFloatType}).fromEquirectangularTexture(renderer, sky);
    window.made = new THREE.PMREMGenerator(renderer).fromCubemap(cube.texture);
    // Reading waits for the graphics.
    return energy(made, 4);
};
window.energies = levels => [...Array(levels).keys()].map(level => energy(made, level));
window.isReady = true;
</script>`;

const TYPES = {".js": "text/javascript"};
const server = createServer((request, response) => {
    const path = request.url === "/sky.hdr" ? sky : join(modules, request.url);
    try {
        response.setHeader("Content-Type", TYPES[extname(path)] ?? "application/octet-stream");
        response.end(request.url === "/" ? (response.setHeader("Content-Type", "text/html"), PAGE) : readFileSync(path));
    } catch {
        response.writeHead(404).end();
    }
}).listen(0, "127.0.0.1");
const browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
try {
    const page = await browser.newPage();
    page.on("console", message => console.error(message.text()));
    page.on("pageerror", error => console.error(String(error)));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.waitForFunction("window.isReady", {timeout: 60000});
    const root = browser.process().pid, before = cpuSeconds(root);
    await page.evaluate(`make(${EDGE})`);
    const seconds = cpuSeconds(root) - before;
    const energies = await page.evaluate(`energies(${LEVELS})`);
    console.log(JSON.stringify({seconds, energies}));
} finally {
    await browser.close();
    server.close();
}

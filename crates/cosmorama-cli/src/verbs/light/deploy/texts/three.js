// Made by cosmorama light deploy: loads the textures beside this file.
import { CompressedCubeTexture, LightProbe, LinearFilter, LinearMipmapLinearFilter, LinearSRGBColorSpace } from "three";

/** A cube of a texture by KTX2Loader, which lays the six faces of a level into one array. */
export function cube(texture) {
  const part = ({ data, width, height }, face) => {
    const length = data.length / 6;
    return { data: data.subarray(face * length, (face + 1) * length), width, height };
  };
  const { width, height } = texture.mipmaps[0];
  const faces = [0, 1, 2, 3, 4, 5].map((face) => ({
    mipmaps: texture.mipmaps.map((level) => part(level, face)),
    width,
    height,
  }));
  const made = new CompressedCubeTexture(faces, texture.format, texture.type);
  made.minFilter = LinearMipmapLinearFilter;
  made.magFilter = LinearFilter;
  made.colorSpace = LinearSRGBColorSpace;
  made.needsUpdate = true;
  return made;
}

/** Textures for scene.background and scene.environment. */
export async function load(ktx2Loader, folder = new URL(".", import.meta.url)) {
  const texture = async (name) => cube(await ktx2Loader.loadAsync(new URL(name, folder).href));
  const [background, environment] = await Promise.all(["sky.ktx2", "specular.ktx2"].map(texture));
  // It is filtered already.
  environment.isPMREMTexture = true;
  return { background, environment };
}

/** A light probe of the parsed probe.json, for scenes without an environment. */
export function probe({ coefficients }) {
  const made = new LightProbe();
  made.sh.fromArray(coefficients.flat());
  return made;
}

// Plays vertex-animation textures with three.js, as a shader would, and writes where every vertex is in every frame: metres, as
// 32-bit numbers.
//
//     node textures.mjs FRAMES FILE.exr...    writes FILE.exr.f32; the mesh is FILE.exr.glb

import { readFileSync, writeFileSync } from "node:fs";

import { FloatType } from "three";
import { EXRLoader } from "three/addons/loaders/EXRLoader.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

function buffer(file) {
    const bytes = readFileSync(file);
    return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

const [frames, ...files] = process.argv.slice(2);
for (const file of files) {
    const { data, width, height } = new EXRLoader().setDataType(FloatType).parse(buffer(file));
    const { scene } = await new GLTFLoader().parseAsync(buffer(`${file}.glb`), "");
    let hair = null;
    scene.traverse((thing) => {
        if (thing.geometry) hair = thing;
    });
    const { position, uv1 } = hair.geometry.attributes;
    const points = new Float32Array(3 * position.count * frames);
    for (let n = 0; n < frames; n++) {
        for (let i = 0; i < position.count; i++) {
            // The loader puts the last row first.
            const v = 1 - (uv1.getY(i) + n / frames);
            const texel = Math.floor(v * height) * width + Math.floor(uv1.getX(i) * width);
            points.set(data.subarray(4 * texel, 4 * texel + 3), 3 * (n * position.count + i));
        }
    }
    writeFileSync(`${file}.f32`, points);
}

// Plays .glb files with three.js, and writes where its skinning has every vertex in every frame: metres, as 32-bit numbers.
//
//     node three.mjs FRAMES RATE FILE.glb...    writes FILE.glb.f32

import { readFileSync, writeFileSync } from "node:fs";

import { AnimationMixer, LoopOnce, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const [frames, rate, ...files] = process.argv.slice(2);
for (const file of files) {
    const bytes = readFileSync(file);
    const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
    const { scene, animations } = await new GLTFLoader().parseAsync(buffer, "");
    let hair = null;
    scene.traverse((thing) => {
        if (thing.isLineSegments || thing.isSkinnedMesh) hair = thing;
    });
    const mixer = new AnimationMixer(scene);
    for (const clip of animations) {
        const action = mixer.clipAction(clip).setLoop(LoopOnce);
        action.clampWhenFinished = true;
        action.play();
    }
    const count = hair.geometry.attributes.position.count;
    const points = new Float32Array(3 * count * frames);
    for (let n = 0; n < frames; n++) {
        mixer.setTime(n / rate);
        scene.updateMatrixWorld(true);
        if (hair.skeleton) hair.skeleton.update();
        for (let v = 0; v < count; v++) {
            const p = new Vector3();
            hair.getVertexPosition(v, p);
            p.applyMatrix4(hair.matrixWorld).toArray(points, 3 * (n * count + v));
        }
    }
    writeFileSync(`${file}.f32`, points);
}

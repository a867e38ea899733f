//! Motion of heads that took gigabytes or minutes, made small.

use super::layers::Made;

pub fn all() -> Vec<Made> {
    let mut made = Vec::new();

    // Two poses, days apart; a row of nothing but commas.
    let header = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw";
    made.push(("days.csv", format!("{header}\n0,0,0,0,0,0,0,1\n400000,0,0,0,0,0,0,1\n").into()));
    made.push(("commas.csv", format!("{header}{}\n0,0,0,0,0,0,0,1{0}\n", ",".repeat(4_000_000)).into()));

    // A thousand joints, of which one moves, over very many frames.
    let joints = "JOINT b {\nOFFSET 1 0 0\n".repeat(998);
    let hierarchy = format!(
        "HIERARCHY\nROOT a {{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n{joints}JOINT Head {{\nOFFSET 0 0 0\n}}{}\n",
        "}".repeat(999)
    );
    let rows = "0\n".repeat(1_000_000);
    made.push(("chain.bvh", format!("{hierarchy}MOTION\nFrames: 1000000\nFrame Time: 0.01\n{rows}").into()));

    let bone = |n: usize| format!("begin\nname b{n}\ndirection 0 1 0\nlength 1\nend\n");
    let bones: String = (0..990).map(bone).collect();
    let hang: String = (1..990).map(|n| format!("b{} b{n}\n", n - 1)).collect();
    let head = "begin\nname Head\ndirection 0 1 0\nlength 1\nend\n";
    let skeleton = format!(
        ":version 1\n:units\nlength 1\nangle deg\n:root\norder\n:bonedata\n{bones}{head}:hierarchy\nbegin\nroot b0\n{hang}b989 Head\nend\n"
    );
    made.push(("chain.skeleton.asf", skeleton.into()));
    let frames: String = (1..300_000).map(|n| format!("{n}\n")).collect();
    made.push(("chain.amc", frames.into()));

    // The same in a table of nodes, moved from the first to the last of days.
    let nodes: Vec<String> = (1..900).map(|n| format!(r#"{{"children":[{n}]}}"#)).collect();
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{},{{"name":"Head"}}],"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],
        "samplers":[{{"input":0,"output":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[10000]}},
        {{"bufferView":0,"byteOffset":8,"componentType":5126,"count":2,"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":32}}],"buffers":[{{"byteLength":32,"uri":"data:application/octet-stream;base64,AAAAAABAHEYAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA="}}]}}"#,
        nodes.join(",")
    );
    made.push(("chain.gltf", text.into()));
    made
}

// The head and other bodies, lit as the renderer lights skin (its skin/light.rs). Light is worked out once a corner: the triangles
// of a head are a few pixels wide.

struct Corner {
    place: vec3f,
    stubble: f32, // part of the skin that hair too short to be drawn covers
    normal: vec3f,
    sheen: f32, // part of the skin's sheen that paint leaves
    colour: vec3f,
    pad_too: f32,
}

@group(1) @binding(0) var<storage, read> corners: array<Corner>;
@group(1) @binding(1) var<storage, read_write> lit: array<vec4f>;

// What arrives through n hairs: unscattered, and scattered forward as among the hair itself.
fn through(n: f32) -> vec3f {
    let straight = exp(-n);
    return straight + g.sky_below.w * max(exp(-n * g.decay.rgb) - straight, vec3f(0.0));
}

@compute @workgroup_size(64)
fn light(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let i = id.x + id.y * groups.x * 64u;
    if i >= arrayLength(&corners) {
        return;
    }
    let place = corners[i].place;
    let normal = corners[i].normal;
    let eye = toward_eye(place);
    // Red light spreads farthest under skin.
    let soft = vec3f(1.25, 0.8, 0.6) * g.skin.w;
    // Off the skin by more than the cells over which hair is spread, or that on the far side of it would count. Fitted.
    let depth = textureSampleLevel(hair_depth, between, in_volume(place + 1.6 * normal), 0.0);
    let open = textureSampleLevel(sky_open, between, in_volume(place + 2.2 * normal), 0.0).xy;
    var diffuse = vec3f(0.0);
    var sheen = vec3f(0.0);
    for (var l = 0u; l < g.counts.x; l++) {
        let lamp = g.lamps[l];
        let facing = dot(normal, lamp.toward);
        var arrives = lamp.strength;
        if lamp.channel >= 0 {
            arrives *= through(depth[lamp.channel]) * past_head(place + 0.3 * normal, lamp.toward);
        }
        let halfway = normalize(lamp.toward + eye);
        let gloss = 0.405 * pow(max(dot(normal, halfway), 0.0), 18.0) * smoothstep(0.0, 0.25, facing);
        let rim = pow(1.0 - clamp(dot(eye, normal), 0.0, 1.0), 4.0) * max(facing, 0.0);
        let within = max(facing + soft, vec3f(0.0));
        let wrapped = select(within * within / max(4.0 * soft, vec3f(1e-6)), vec3f(facing), vec3f(facing) >= soft);
        diffuse += arrives * wrapped;
        sheen += arrives * (gloss + 0.5 * rim);
    }
    // What other skin sends: known in the cells that skin passes through.
    let glow = textureSampleLevel(sky_open, between, in_volume(place), 0.0).zw;
    diffuse += g.skin.rgb * glow.x / max(glow.y, 1e-3);
    let up = 0.5 + 0.5 * dot(normal, g.zenith.xyz);
    diffuse += g.sky_above.rgb * up * through(-log(max(open.x, 1e-6)));
    diffuse += g.sky_below.rgb * (1.0 - up) * through(-log(max(open.y, 1e-6)));
    let skin = corners[i].colour * diffuse + g.hair.w * corners[i].sheen * sheen;
    lit[i] = vec4f(mix(skin, g.hair.rgb * diffuse, corners[i].stubble), 1.0);
}

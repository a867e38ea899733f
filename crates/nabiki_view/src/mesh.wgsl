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

// What arrives through so many hairs in the mean, unscattered, and scattered forward as among the hair itself. Hair falls in locks, and
// between them are fewer: as much arrives as through n hairs everywhere.
fn through(mean: f32) -> vec3f {
    let n = log(1.0 + mean);
    let straight = exp(-n);
    return straight + g.sky_below.w * max(exp(-n * g.decay.rgb) - straight, vec3f(0.0));
}

// What hair between skin and eye hides of it beyond what of that hair is drawn. Its first part lies beside skin as well as before it, since
// cells are wide: it is left out (fitted). Hair falls in locks, so that more shows between them than through as much hair strewn evenly.
fn hidden(place: vec3f, normal: vec3f, eye: vec3f) -> f32 {
    if g.axes.w >= 1.0 {
        return 0.0;
    }
    let cell = 1.0 / g.volume_low.w;
    var met = 0.0;
    var far = 0.5;
    var step = 0.6;
    for (var k = 0; k < 6; k++) {
        met += step * held(place + cell * (0.3 * normal + (far + 0.5 * step) * eye));
        far += step;
        step *= 1.5;
    }
    let more = max(met - 0.4, 0.0) * (1.0 - g.axes.w);
    return more / (1.0 + more);
}

// The light of a mass of hair before skin, as the eye sees it.
fn mass(place: vec3f, normal: vec3f) -> vec3f {
    let at = place + normal / g.volume_low.w;
    let out = out_of_hair(at);
    let seen = seen_at(at, out);
    let depth = depth_from(seen);
    let open = textureSampleLevel(sky_open, between, in_volume(seen), 0.0).xy;
    let up = 0.5 + 0.5 * dot(out, g.zenith.xyz);
    var light = g.sky_above.rgb * up * open.x + g.sky_below.rgb * (1.0 - up) * open.y;
    for (var l = 0u; l < g.counts.x; l++) {
        let lamp = g.lamps[l];
        if lamp.channel >= 0 {
            light += lamp.strength * max(dot(out, lamp.toward), 0.0) * through(depth[lamp.channel]) * past_head(seen, lamp.toward);
        }
    }
    return g.hair.rgb * light;
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
    // Off the skin by more than half a cell, or hair on the far side of it would count. Fitted.
    let depth = depth_from(place + 0.9 * normal);
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
    var seen = mix(skin, g.hair.rgb * diffuse, corners[i].stubble);
    let covered = hidden(place, normal, eye);
    if covered > 0.0 {
        seen = mix(seen, mass(place, normal), covered);
    }
    lit[i] = vec4f(seen, 1.0);
}

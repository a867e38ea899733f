// What every shader of the view knows. All places and directions are in head space (cm): the head stands still, the camera
// and the lamps go round it.

struct Lamp {
    toward: vec3f,   // unit, toward the lamp
    channel: i32,    // of the volume of hair depths; -1 beyond the fourth lamp
    strength: vec3f, // linear
    pad: f32,
}

struct Globals {
    eye: vec4f,
    right: vec4f,
    up: vec4f,
    forward: vec4f,
    screen: vec4f,      // width and height (px), px that 1 cm at depth 1 cm covers, 1 if rays are parallel
    lamps: array<Lamp, 16>,
    counts: vec4u,      // lamps, points of strands, pieces of a segment + 65536 x hairs of a lock, 1 for Kajiya and Kay
    sky_above: vec4f,   // SKY_KEPT last
    sky_below: vec4f,   // ON_SKIN last
    zenith: vec4f,
    skin: vec4f,        // colour of bare skin, softness
    hair: vec4f,        // colour of a mass of hair, sheen of skin
    decay: vec4f,       // how fast light that hair scatters grows less with each hair
    volume_low: vec4f,  // corner of the volume, 1 / cell
    volume_size: vec4f, // cells
    spread: vec4f,      // variances of R, TT and TRT, STRAYS
    look: vec4f,        // tilt, spread of tilts, exponent of Kajiya and Kay's highlight, least half width (px)
    width: vec4f,       // half width at the root (cm), part of it at the tip, taper, half width of a lock (cm)
    centre: vec4f,      // of the head ellipsoid
    axes: vec4f,        // its half axes, part of the whole hair's breadth that is drawn
}

@group(0) @binding(0) var<uniform> g: Globals;
@group(0) @binding(1) var hair_depth: texture_3d<f32>;
// As volume/sky_light.rs has them.
@group(0) @binding(2) var sky_seen: texture_3d<f32>;
@group(0) @binding(3) var skin_seen: texture_3d<f32>;
@group(0) @binding(4) var about_lamps: texture_3d<f32>;
@group(0) @binding(5) var opposite_lamps: texture_3d<f32>;
@group(0) @binding(6) var sky_open: texture_3d<f32>;
@group(0) @binding(7) var between: sampler;
@group(0) @binding(8) var hair_held: texture_3d<f32>; // hairs met in a full crossing of a cell

const PI: f32 = 3.14159265;
const NEAR: f32 = 1.0;
const FAR: f32 = 1e5;

// Depth is reversed, so that it is as fine far away as near: 1 at the near plane, 0 at infinity.
fn clip_of(p: vec3f) -> vec4f {
    let d = p - g.eye.xyz;
    let depth = dot(d, g.forward.xyz);
    let xy = vec2f(dot(d, g.right.xyz), dot(d, g.up.xyz)) * 2.0 * g.screen.z / g.screen.xy;
    if g.screen.w > 0.5 {
        return vec4f(xy, 1.0 - depth / FAR, 1.0);
    }
    return vec4f(xy, NEAR, depth);
}

fn toward_eye(p: vec3f) -> vec3f {
    if g.screen.w > 0.5 {
        return -g.forward.xyz;
    }
    return normalize(g.eye.xyz - p);
}

fn pixels_per_cm(p: vec3f) -> f32 {
    if g.screen.w > 0.5 {
        return g.screen.z;
    }
    return g.screen.z / max(dot(p - g.eye.xyz, g.forward.xyz), NEAR);
}

// Away from the head.
fn outward_of(p: vec3f) -> vec3f {
    return normalize((p - g.centre.xyz) / (g.axes.xyz * g.axes.xyz) + vec3f(0.0, 1e-9, 0.0));
}

fn in_volume(p: vec3f) -> vec3f {
    return (p - g.volume_low.xyz) * g.volume_low.w / g.volume_size.xyz;
}

// How much hair is about a place.
fn held(p: vec3f) -> f32 {
    return textureSampleLevel(hair_held, between, in_volume(p), 0.0).x;
}

// Out of the hair about a place; away from the head where it is the same all about.
fn out_of_hair(p: vec3f) -> vec3f {
    let d = 1.5 / g.volume_low.w;
    let less = vec3f(
        held(p - vec3f(d, 0.0, 0.0)) - held(p + vec3f(d, 0.0, 0.0)),
        held(p - vec3f(0.0, d, 0.0)) - held(p + vec3f(0.0, d, 0.0)),
        held(p - vec3f(0.0, 0.0, d)) - held(p + vec3f(0.0, 0.0, d)),
    );
    return normalize(less / (held(p) + 0.01) + 0.3 * outward_of(p));
}

// Where light is looked up for a hair at a place that is seen `along` a direction: what the eye sees of dense hair lies no deeper than
// SEEN hairs, though the wide cells put it deeper. Steps are longer far out, where less depends on them.
const SEEN: f32 = 0.45;
const DEEPEST: f32 = 6.0; // cells

fn seen_at(p: vec3f, along: vec3f) -> vec3f {
    let cell = 1.0 / g.volume_low.w;
    var met = 0.0;
    var at = DEEPEST;
    while at > 0.0 {
        let step = max(0.4, 0.2 * at);
        met += step * held(p + along * (at - 0.5 * step) * cell);
        if met > SEEN {
            break;
        }
        at -= step;
    }
    return p + along * max(at, 0.0) * cell;
}

// Hairs between a place and each lamp. From beyond the cells it is asked where the way to the lamp enters them.
fn depth_from(p: vec3f) -> vec4f {
    let at = in_volume(p);
    var depth = textureSampleLevel(hair_depth, between, at, 0.0);
    if all(at >= vec3f(0.0)) && all(at <= vec3f(1.0)) {
        return depth;
    }
    for (var l = 0u; l < min(g.counts.x, 4u); l++) {
        let way = g.lamps[l].toward * g.volume_low.w / g.volume_size.xyz;
        let safe = select(way, vec3f(1e-9), abs(way) < vec3f(1e-9));
        let a = -at / safe;
        let b = (1.0 - at) / safe;
        let near = min(a, b);
        let far = max(a, b);
        let enters = max(max(near.x, near.y), max(near.z, 0.0));
        let leaves = min(far.x, min(far.y, far.z));
        depth[l] = 0.0;
        if enters < leaves {
            depth[l] = textureSampleLevel(hair_depth, between, at + safe * enters, 0.0)[l];
        }
    }
    return depth;
}

// What the head leaves of a lamp: exact for its ellipsoid, whose rim is made as soft as a shadow on hair is.
fn past_head(p: vec3f, toward: vec3f) -> f32 {
    let q = (p - g.centre.xyz) / g.axes.xyz;
    let d = toward / g.axes.xyz;
    let t = -dot(q, d) / dot(d, d);
    let nearest = length(q + d * t);
    return select(smoothstep(0.82, 1.0, nearest), 1.0, t <= 0.0);
}

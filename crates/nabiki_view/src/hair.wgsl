// Strands: one pass lights their points, one lays ribbons through them, one draws these.
//
// Light and shape are worked out once a point and not once a pixel, as the renderer does it: hair is thinner than a pixel, and
// software rasterisers run compute on all cores but vertices on one.

struct Vertex {
    clip: vec4f,
    light: vec3f,
    share: f32, // of a pixel, plus twice a whole number of the strand
}

// Many hairs of a grade, as light crosses them in the mean (the renderer's light/streams.rs).
struct Medium {
    forward: vec3f,
    back: vec3f,
    whole: vec3f,
    decay: vec3f,
}

@group(1) @binding(0) var<storage, read> points: array<f32>;          // x, y, z of each
@group(1) @binding(1) var<storage, read> marks: array<u32>;           // bit 0 root, bit 1 tip, bits 2-11 part of the length, strand
@group(1) @binding(2) var<storage, read> lobes: array<f32>;           // FibreTables
@group(1) @binding(3) var<storage, read> rows: array<f32>;
@group(1) @binding(4) var<storage, read> mediums: array<Medium>;
@group(1) @binding(5) var<storage, read_write> lights: array<vec4f>;
@group(1) @binding(6) var<storage, read_write> ribbons: array<Vertex>;

const GRADES: u32 = 8u;
const ROWS: u32 = 24u;
const COLUMNS: u32 = 64u;

fn point(i: u32) -> vec3f {
    return vec3f(points[3u * i], points[3u * i + 1u], points[3u * i + 2u]);
}

// A number in 0..1 that belongs to a strand and a purpose: the renderer's own, so that each hair has its colour there.
fn of_strand(strand: u32, purpose: u32) -> f32 {
    var h = (strand * 0x9E3779B1u) ^ (purpose * 0x85EBCA77u);
    h = (h ^ (h >> 16u)) * 0x7FEB352Du;
    h = (h ^ (h >> 15u)) * 0x846CA68Bu;
    h = h ^ (h >> 16u);
    return f32(h >> 8u) / 16777216.0;
}

// Direction at a point: through its neighbours, so that neighbouring pieces share it.
fn tangent_at(i: u32) -> vec3f {
    let mark = marks[i];
    let before = point(select(i - 1u, i, (mark & 1u) != 0u));
    let after = point(select(i + 1u, i, (mark & 2u) != 0u));
    let d = after - before;
    let l = length(d);
    return select(vec3f(0.0, -1.0, 0.0), d / l, l > 1e-6);
}

// e^-x I_0(x), as the renderer has it.
fn scaled_bessel(x: f32) -> f32 {
    let s = x * x;
    let cosh = 0.5 + 0.5 * exp(-2.0 * x);
    return cosh * (1.0 + 0.24273 * s) / ((1.0 + 0.43023 * s) * sqrt(sqrt(1.0 + 0.25 * s)));
}

// Shape of a lobe along the hair (d'Eon et al. 2011).
fn along(variance: f32, sin_lamp: f32, cos_lamp: f32, sin_eye: f32, cos_eye: f32) -> f32 {
    let per = 1.0 / variance;
    let norm = per / (1.0 - exp(-2.0 * per));
    let a = cos_lamp * cos_eye * per;
    let b = sin_lamp * sin_eye * per;
    return norm * scaled_bessel(a) * exp(min(a - b - per, 0.0));
}

fn row_at(grade: u32, row: f32, part: u32) -> vec3f {
    let r = min(u32(row), ROWS - 2u);
    let v = row - f32(r);
    let at = (grade * ROWS + r) * 12u + part * 4u;
    let a = vec3f(rows[at], rows[at + 1u], rows[at + 2u]);
    let b = vec3f(rows[at + 12u], rows[at + 13u], rows[at + 14u]);
    return mix(a, b, v);
}

fn lobe(at: u32) -> array<f32, 7> {
    return array<f32, 7>(lobes[at], lobes[at + 1u], lobes[at + 2u], lobes[at + 3u], lobes[at + 4u], lobes[at + 5u], lobes[at + 6u]);
}

struct Azimuthal {
    r: f32,
    tt: vec3f,
    trt: vec3f,
}

fn lobes_at(grade: u32, row: f32, column: f32) -> Azimuthal {
    let r = min(u32(row), ROWS - 2u);
    let c = min(u32(column), COLUMNS - 1u);
    let v = row - f32(r);
    let u = column - f32(c);
    let at = ((grade * ROWS + r) * (COLUMNS + 1u) + c) * 8u;
    let below = at + (COLUMNS + 1u) * 8u;
    let a = lobe(at);
    let b = lobe(at + 8u);
    let d = lobe(below);
    let e = lobe(below + 8u);
    var m: array<f32, 7>;
    for (var i = 0u; i < 7u; i++) {
        m[i] = mix(mix(a[i], b[i], u), mix(d[i], e[i], u), v);
    }
    return Azimuthal(m[0], vec3f(m[1], m[2], m[3]), vec3f(m[4], m[5], m[6]));
}

// Kajiya and Kay (1989), as the renderer has it.
fn cylinder(p: vec3f, t: vec3f, eye: vec3f, depth: vec4f, sky: vec4f) -> vec3f {
    let colour = g.hair.rgb;
    var light = 0.5 * colour * (g.sky_above.rgb * (sky.x + sky.z) + g.sky_below.rgb * (sky.y + sky.w));
    for (var l = 0u; l < g.counts.x; l++) {
        let lamp = g.lamps[l];
        let sl = dot(t, lamp.toward);
        let se = dot(t, eye);
        let across_lamp = sqrt(max(1.0 - sl * sl, 0.0));
        let mirrored = max(across_lamp * sqrt(max(1.0 - se * se, 0.0)) - sl * se, 0.0);
        let part = colour * across_lamp + 0.35 * pow(mirrored, g.look.z);
        light += part * lamp.strength * exp(-crossed(lamp, depth)) * past_head(p, lamp.toward);
    }
    return light;
}

// Hairs between a place and a lamp.
fn crossed(lamp: Lamp, depth: vec4f) -> f32 {
    if lamp.channel < 0 {
        return 0.0;
    }
    return depth[lamp.channel];
}

// What hair leaves of the sky's light, as a share of what is open without it.
fn share(open: f32, bare: f32) -> f32 {
    return clamp(open / max(bare, 1e-6), 1e-6, 1.0);
}

// The same with what it scatters forward, since hair passes on a part a.
fn passed_on(share: f32, a: vec3f) -> vec3f {
    return max(pow(vec3f(share), max(1.0 - g.sky_above.w * a, vec3f(0.0))), vec3f(share));
}

// Light within a slab of hair: away from the lamp (the first) and back to it, as the renderer's light/streams.rs has it.
fn slab(whole: vec3f, before: vec3f, behind: vec3f) -> array<vec3f, 2> {
    let far = behind * behind;
    let sent = whole * whole;
    let part = before / max(1.0 - sent * before * before * far, vec3f(1e-6));
    return array<vec3f, 2>((1.0 - sent * far) * part, whole * (1.0 - far) * part);
}

// What is known of a place: hairs before the lamps, the sky's light, skin's, and how open it is about the lamps and opposite.
struct About {
    depth: vec4f,
    sky: vec4f,
    skin: vec4f,
    toward: vec4f,
    opposite: vec4f,
}

// The renderer's fibre and scattered light; see its light/shade.rs for the reasons.
fn fibre(p: vec3f, t: vec3f, eye: vec3f, strand: u32, about: About) -> vec3f {
    let tilt = g.look.x + g.look.y * (of_strand(strand, 1u) + of_strand(strand, 2u) - 1.0);
    let grade = min(u32((of_strand(strand, 3u) + of_strand(strand, 4u)) * 0.5 * f32(GRADES)), GRADES - 1u);
    let se = clamp(dot(t, eye), -0.9995, 0.9995);
    let ce = sqrt(1.0 - se * se);
    let row = abs(se) * f32(ROWS - 1u);
    let a = row_at(grade, row, 0u);
    let b = row_at(grade, row, 1u);
    let rest = row_at(grade, row, 2u);
    let medium = mediums[grade];
    let sky = about.sky;
    let through_front = share(sky.x + sky.y, about.skin.z);
    let front = (g.sky_above.rgb * sky.x + g.sky_below.rgb * sky.y) * passed_on(through_front, medium.forward) / through_front
        + g.skin.rgb * about.skin.x;
    let through_behind = share(sky.z + sky.w, about.skin.w);
    let arriving = passed_on(through_behind, medium.forward);
    let from_behind = (g.sky_above.rgb * sky.z + g.sky_below.rgb * sky.w) * arriving / through_behind
        + g.skin.rgb * about.skin.y;
    let closed = max(1.0 - arriving * about.skin.w, vec3f(0.0));
    let again = g.sky_above.w * max(medium.whole - medium.back, vec3f(0.0)) * closed;
    var light = mix(front, from_behind, se * se) * (b + again) + from_behind * a;
    let of_forward = 0.5 * (g.spread.x + g.spread.y);
    let home = g.spread.z + of_forward * (medium.forward.g / medium.decay.g - 1.0);
    let strays = g.spread.w * medium.forward;
    for (var l = 0u; l < g.counts.x; l++) {
        let lamp = g.lamps[l];
        let sl = clamp(dot(t, lamp.toward), -0.9995, 0.9995);
        let cl = sqrt(1.0 - sl * sl);
        let azimuth = clamp((dot(lamp.toward, eye) - sl * se) / (cl * ce), -1.0, 1.0);
        let seen = lobes_at(grade, row, acos(azimuth) * f32(COLUMNS) / PI);
        // R leans toward the root, TT and TRT toward the tip: the scales of the cuticle.
        let turn = vec3f(2.0, -1.0, -3.0) * tilt;
        let s = se * cos(turn) + ce * sin(turn);
        let c = abs(ce * cos(turn) - se * sin(turn));
        let m_r = along(g.spread.x, sl, cl, s.x, c.x);
        let m_tt = along(g.spread.y, sl, cl, s.y, c.y);
        let m_trt = along(g.spread.z, sl, cl, s.z, c.z);
        let same_side = 0.5 * (1.0 + azimuth) / PI;
        let far_side = 0.5 * (1.0 - azimuth) / PI;
        let n = crossed(lamp, about.depth);
        // Where it is not known what is about, as much as straight on, and hair without end behind.
        var aside = n;
        var behind = 100.0;
        if l < 4u && about.toward[l] <= 1.0 {
            aside = -log(clamp(about.toward[l], 1e-6, 1.0));
            behind = -log(clamp(about.opposite[l], 1e-6, 1.0));
        }
        let straight = exp(-n);
        let once = m_r * seen.r + m_tt * seen.tt + m_trt * (seen.trt + rest);
        let before = (1.0 - strays) * exp(-n * medium.decay) + strays * exp(-aside * medium.decay);
        let streams = slab(medium.whole, before, exp(-behind * medium.decay));
        let variance = 2.0 * g.spread.x + of_forward * n * medium.forward.g;
        let away = along(min(variance, 1.0), sl, cl, se, ce) * max(streams[0] - straight, vec3f(0.0));
        let back = along(min(variance + home, 1.0), sl, cl, se, ce) * streams[1];
        let part = straight * once + away * (b * same_side + a * far_side) + back * (a * same_side + b * far_side);
        light += PI * past_head(p, lamp.toward) * lamp.strength * part;
    }
    return light;
}

@compute @workgroup_size(64)
fn shade(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let i = id.x + id.y * groups.x * 64u;
    if i >= g.counts.y {
        return;
    }
    let p = point(i);
    let t = tangent_at(i);
    let eye = toward_eye(p);
    // Hair that is seen lies on the surface, before the cells over which it is spread itself: it sees the lamp.
    let out = out_of_hair(p);
    let seen = seen_at(p, eye);
    let at = in_volume(seen);
    // The sky's cells are twice as wide.
    let above = in_volume(seen + out * 0.8 / g.volume_low.w);
    let about = About(
        textureSampleLevel(hair_depth, between, at, 0.0),
        textureSampleLevel(sky_seen, between, above, 0.0),
        textureSampleLevel(skin_seen, between, above, 0.0),
        textureSampleLevel(about_lamps, between, above, 0.0),
        textureSampleLevel(opposite_lamps, between, above, 0.0),
    );
    var light: vec3f;
    if g.counts.w == 1u {
        light = cylinder(p, t, eye, about.depth, about.sky);
    } else {
        light = fibre(p, t, eye, marks[i] >> 12u, about);
    }
    lights[i] = vec4f(light, 0.0);
}

// A curve through four points (Catmull and Rom), between the second and the third.
fn curve(a: vec3f, b: vec3f, c: vec3f, d: vec3f, u: f32) -> vec3f {
    return 0.5 * (2.0 * b + u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * b - a - 3.0 * c + d))));
}

fn slope(a: vec3f, b: vec3f, c: vec3f, d: vec3f, u: f32) -> vec3f {
    return 0.5 * (c - a + u * (2.0 * (2.0 * a - 5.0 * b + 4.0 * c - d) + 3.0 * u * (3.0 * b - a - 3.0 * c + d)));
}

// A strand that stands for many is drawn as some of them, spread over the place that the roots of the others take: beside it
// along the head, and a little above it, closing toward the tip as locks do.
fn in_lock(strand: u32, child: u32, at: vec3f, tangent: vec3f, part: f32) -> vec3f {
    if child == 0u {
        return vec3f(0.0);
    }
    let outward = outward_of(at);
    let beside = cross(tangent, outward);
    let l = length(beside);
    let aside = select(g.right.xyz, beside / l, l > 1e-3);
    let x = 2.0 * of_strand(strand, 10u + 2u * child) - 1.0;
    let y = of_strand(strand, 11u + 2u * child);
    return g.width.w * (1.0 - 0.45 * part) * (x * aside + 0.3 * y * outward);
}

@compute @workgroup_size(64)
fn lay(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let j = id.x + id.y * groups.x * 64u;
    let pieces = g.counts.z & 0xFFFFu;
    let children = g.counts.z >> 16u;
    if j >= g.counts.y * pieces * children {
        return;
    }
    let child = j / (g.counts.y * pieces);
    let piece = j % (g.counts.y * pieces);
    let i = piece / pieces;
    let u = f32(piece % pieces) / f32(pieces);
    let mark = marks[i];
    let strand = mark >> 12u;
    let next = select(i + 1u, i, (mark & 2u) != 0u);
    let a = point(select(i - 1u, i, (mark & 1u) != 0u));
    let b = point(i);
    let c = point(next);
    let d = point(select(next + 1u, next, (marks[next] & 2u) != 0u));
    let way = slope(a, b, c, d, u);
    let part = mix(f32((mark >> 2u) & 1023u), f32((marks[next] >> 2u) & 1023u), u) / 1023.0;
    let middle = curve(a, b, c, d, u);
    let at = middle + in_lock(strand, child, middle, normalize(way + vec3f(0.0, 1e-9, 0.0)), part);
    var side = cross(way, toward_eye(at));
    let l = length(side);
    side = select(g.right.xyz, side / l, l > 1e-6);
    let thin = clamp((part - 1.0 + g.width.z) / max(g.width.z, 1e-6), 0.0, 1.0);
    // The hairs of a lock end one after another: ends in a row look like a brush.
    let ends = select(1.0 - 0.3 * of_strand(strand, 70u + child), 2.0, child == 0u);
    let half = g.width.x * (1.0 - thin * (1.0 - g.width.y)) * (1.0 - smoothstep(ends - 0.08, ends, part));
    // Thinner than a pixel it would fall between samples and break into dots: it is drawn wide enough to meet a sample
    // of each pixel on its way, and takes its share of them.
    let least = g.look.w / pixels_per_cm(at);
    let share = min(half / least, 0.999) + 2.0 * floor(of_strand(strand, 100u + child) * 64.0);
    // The hairs of a lock are shaded as one, and differ as hairs do.
    let tone = select(mix(0.72, 1.28, of_strand(strand, 40u + child)), 1.0, children == 1u);
    let light = mix(lights[i].rgb, lights[next].rgb, u) * tone;
    let wide = side * max(half, least);
    ribbons[2u * j] = Vertex(clip_of(at - wide), light, share);
    ribbons[2u * j + 1u] = Vertex(clip_of(at + wide), light, share);
}

// From light to what a display shows: background, exposure, tone curve and sRGB as in the renderer's pictures.

struct Show {
    top: vec4f,    // sRGB as displayed, exposure as a factor
    bottom: vec4f, // sRGB as displayed, 1 for the filmic curve
}

@group(0) @binding(0) var<uniform> show: Show;
@group(0) @binding(1) var light: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn strongest(colour: vec3f) -> f32 {
    return max(colour.r, max(colour.g, colour.b));
}

fn displayed(scene: vec3f) -> vec3f {
    var curve = max(scene * show.top.w, vec3f(0.0));
    let bright = strongest(curve);
    if show.bottom.w < 0.5 {
        curve = min(curve, vec3f(1.0));
    } else if bright > 0.5 {
        let shown = 1.0 - 0.5 * exp(-(bright - 0.5) / 0.5);
        curve = shown * pow(curve / bright, vec3f(shown / bright));
    }
    return select(1.055 * pow(curve, vec3f(1.0 / 2.4)) - 0.055, 12.92 * curve, curve <= vec3f(0.0031308));
}

// The inverse, for the background, whose colours are given as displayed: mixed with hair as light, as everything is.
fn scene(srgb: vec3f) -> vec3f {
    var y = select(pow((srgb + 0.055) / 1.055, vec3f(2.4)), srgb / 12.92, srgb <= vec3f(0.04045));
    let shown = strongest(y);
    if show.bottom.w > 0.5 && shown > 0.5 {
        let below_white = min(shown, 0.9999);
        let bright = 0.5 - 0.5 * log((1.0 - below_white) / 0.5);
        y = bright * pow(y / shown, vec3f(bright / below_white));
    }
    return y / show.top.w;
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let here = textureLoad(light, vec2i(at.xy), 0);
    let t = at.y / f32(textureDimensions(light).y);
    let ground = mix(show.top.rgb, show.bottom.rgb, t);
    // Most pixels are all ground or all scene; what costs is only for the rims between.
    if here.a <= 0.0 {
        return vec4f(ground, 1.0);
    }
    if here.a >= 1.0 {
        return vec4f(displayed(here.rgb), 1.0);
    }
    let behind = scene(ground);
    return vec4f(displayed(here.rgb + behind * (1.0 - here.a)), 1.0);
}

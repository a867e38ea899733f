//! Regions by groups and attributes of the hair or its head: which strands belong to them, and what is refused.

use std::fmt::Write;
use std::path::Path;

use glam::Vec3;
use nabiki::dynamics::Form;
use nabiki::free_form::FreeMotion;
use nabiki::solve::{Goal, Node, Search, Solver, Unknown, Wish, nodes_of};
use nabiki_groom::style::Region;
use nabiki_scene::{BuiltScene, Scene, Shown};

fn free(built: &BuiltScene) -> &FreeMotion {
    match &built.dynamics.form {
        Form::Free(free) => free,
        Form::Paper => panic!("the scene is in the free form"),
    }
}

/// How much each shown strand belongs to region 0.
fn weights(built: &BuiltScene) -> Vec<f64> {
    built.strands().iter().map(|strand| free(built).weight_in(0, strand[0])).collect()
}

#[test]
fn grown_hair_belongs_to_regions_by_its_groups() {
    let text = "[motion]\nform = \"free\"\n[hair]\nstrands = 300\n[hair.style.fringe]\nhalf_width = 5\n[neighbours]\ncarriers = 60\n\
                [[free.regions]]\ngroups = [\"fringe\", \"top\"]\nhold = 4\n[[force]]\nthrough = 3\nvector = [-40, 0, 0]";
    let build = |shown| Scene::parse(text, Path::new("s.toml"), &[]).unwrap().build(shown).unwrap();
    let built = build(Shown::All);
    let groups = built.groom.hair.attributes.group.as_ref().unwrap();
    let belongs = |group: i32| [Region::Fringe as i32, Region::Top as i32].contains(&group);
    let expected: Vec<f64> = groups.iter().map(|&group| f64::from(u8::from(belongs(group)))).collect();
    assert_eq!(weights(&built), expected);
    assert!(expected.contains(&0.0) && groups.contains(&(Region::Fringe as i32)));
    // A preview has fewer strands and the same carriers, and each belongs as it does in the whole.
    let few = build(Shown::AtMost(20));
    for strand in few.strands().iter() {
        let whole = built.strands().iter().position(|of| of[0] == strand[0]).unwrap();
        assert_eq!(free(&few).weight_in(0, strand[0]), expected[whole]);
    }
    let carriers = |built: &BuiltScene| free(built).neighbours.clone().unwrap().carriers;
    assert_eq!(carriers(&few), carriers(&built));
    assert_eq!(carriers(&few).len(), 60);
    for carrier in carriers(&few).iter() {
        let whole = built.strands().iter().position(|of| of[0] == carrier[0]).unwrap();
        assert_eq!(free(&few).weight_in(0, carrier[0]), expected[whole]);
    }
}

/// The fields of a scene have names that a region may use, and no other name is taken.
#[test]
fn a_region_feels_a_share_of_single_fields() {
    let scene = |field: &str| {
        let text = format!(
            "[motion]\nform = \"free\"\nframes = 9\n[hair]\nstrands = 8\n[[force]]\nthrough = 3\nvector = [-40, 0, 0]\n\
             [turbulence]\n[[fan]]\nposition = [30, 0, 0]\ndirection = [-1, 0, 0]\n[[free.regions]]\nnear = [0, 0, 0]\n\
             within = 100\nfields = [{{ field = {field:?}, share = 0.25 }}]"
        );
        Scene::parse(&text, Path::new("s.toml"), &[]).unwrap().build(Shown::All).unwrap()
    };
    for field in ["wind", "turbulence", "fan[0]"] {
        scene(field).timeline().unwrap();
    }
    let refused = scene("fan[1]").timeline().err().unwrap().to_string();
    let line = "free.regions[0].fields[0].field = \"fan[1]\": no such field: use one of wind, turbulence, fan[0], or remove it";
    assert!(refused.contains(line), "{refused}");
}

/// A region keeps to the fields that it names when others are removed, and forgets one that is removed. A field that is off
/// refuses nothing.
#[test]
fn regions_keep_to_their_fields_when_others_are_removed() {
    let share = |field: &str| format!("{{ field = {field:?}, share = 0.5 }}");
    let fan = "[[fan]]\nposition = [30, 0, 0]\ndirection = [-1, 0, 0]\n".repeat(3);
    let text = format!(
        "[motion]\nform = \"free\"\nframes = 9\n[hair]\nstrands = 8\n[turbulence]\n{fan}[[free.regions]]\nnear = [0, 0, 0]\n\
         fields = [{}, {}, {}, {}, {}]",
        share("fan[0]"),
        share("fan[1]"),
        share("fan[2]"),
        share("turbulence"),
        share("wind")
    );
    let scene = Scene::parse(&text, Path::new("s.toml"), &[]).unwrap();
    let fewer = scene.with_setting("fan[1]", None).unwrap().with_setting("turbulence", None).unwrap();
    let named: Vec<&str> = fewer.free.regions[0].fields.iter().map(|of| of.field.as_str()).collect();
    assert_eq!(named, ["fan[0]", "fan[1]", "turbulence", "wind"]);
    fewer.build(Shown::All).unwrap().timeline().unwrap();
}

/// Hair that feels a part of the wind, and less of the swirls, leads the solver to the wind that it was moved by.
#[test]
fn the_wind_of_hair_that_feels_a_share_of_it_is_found_again() {
    const FRAMES: u32 = 20;
    let truth = Vec3::new(-50.0, 10.0, 8.0);
    let built = |wind: Vec3| {
        let [x, y, z] = wind.to_array();
        let text = format!(
            "[motion]\nform = \"free\"\nframes = {FRAMES}\n[hair]\nstrands = 12\n[[force]]\nthrough = {FRAMES}\n\
             vector = [{x}, {y}, {z}]\n[turbulence]\nstrength = 20\n[[free.regions]]\nnear = [0, 0, 12]\nwithin = 9\n\
             fields = [{{ field = \"wind\", share = 0.5 }}, {{ field = \"turbulence\", share = 0.2 }}]"
        );
        Scene::parse(&text, Path::new("s.toml"), &[]).unwrap().build(Shown::All).unwrap()
    };
    let was = built(truth);
    let mut timeline = was.timeline().unwrap();
    let film = timeline.play();
    let nodes = |s: usize| nodes_of(s as u32, was.strands().strand(s).len(), 0.3..=1.0);
    let nodes: Vec<Node> = (0..was.strands().len()).flat_map(nodes).collect();
    let places = nodes.iter().map(|of| film.strand(FRAMES, of.strand as usize)[of.node as usize]).collect();
    let wish = Wish { frame: FRAMES, nodes, goal: Goal::Places(places), weight: 1.0 };
    let problem = built(Vec3::new(-20.0, 0.0, 0.0)).problem(vec![Unknown::Vector(0)], vec![wish]);
    let report = Solver::new(problem).unwrap().solve(&Search { near_cm: 0.01, ..Search::default() });
    let found = report.answer.keyframes[0].vector;
    assert!(found.distance(truth) < 1.0, "{found} for {truth}, {} cm left", report.after_cm);
}

#[test]
fn a_group_that_a_preview_does_not_show_is_still_a_group() {
    let text = "[motion]\nform = \"free\"\n[hair]\nstrands = 300\n[[free.regions]]\ngroups = [\"fringe\"]\n[[force]]\n\
                through = 3\nvector = [-40, 0, 0]";
    let built = Scene::parse(text, Path::new("s.toml"), &[]).unwrap().build(Shown::AtMost(3)).unwrap();
    assert_eq!(weights(&built), [0.0; 3]);
    let said: Vec<String> = built.advice().iter().map(ToString::to_string).collect();
    let line = "free.regions[0] does not contain any of the 3 strands: none is in its groups";
    assert!(said.iter().any(|said| said.starts_with(line)), "{said:?}");
}

/// Two prims of curves with a weight per curve, one per point, one that is too large, and words.
const PAINTED: &str = r#"
    float[] primvars:painted = [0.25, 1] ( interpolation = "uniform" )
    float[] primvars:at_points = [0.5, 9, 9, 0, 9, 9] ( interpolation = "vertex" )
    float[] primvars:large = [1.5, 1] ( interpolation = "uniform" )
    int[] primvars:clump = [3, 7] ( interpolation = "uniform" )
    string[] primvars:word = ["a", "b"] ( interpolation = "uniform" )"#;

fn usda() -> String {
    let mut text = "#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = \"Y\"\n)\n".to_owned();
    for (name, x) in [("fringe", 6.0), ("back", -6.0)] {
        let line = |z: f32| format!("({x}, 9, {z}), ({x}, 5, {z}), ({x}, 1, {z})");
        write!(
            text,
            "def BasisCurves \"{name}\"\n{{\n    uniform token type = \"linear\"\n    int[] curveVertexCounts = [3, 3]\n    \
             point3f[] points = [{}, {}]{PAINTED}\n}}\n",
            line(-2.0),
            line(2.0)
        )
        .unwrap();
    }
    text
}

/// The scene of this hair with a region of these settings.
fn of_file(hair: &str, region: &str, more: &str, shown: Shown) -> Result<BuiltScene, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("hair.usda"), hair).unwrap();
    let text = format!(
        "[motion]\nform = \"free\"\n[hair]\nfile = \"hair.usda\"\norigin = [0, 0, 0]\nroot = \"first\"\n{more}\n\
         [[free.regions]]\n{region}\nwind = 0.5\n[[force]]\nthrough = 3\nvector = [-40, 0, 0]"
    );
    let scene = Scene::parse(&text, &folder.path().join("s.toml"), &[]).map_err(|e| e.to_string())?;
    scene.build(shown).map_err(|e| e.to_string())
}

fn imported(region: &str, more: &str, shown: Shown) -> Result<BuiltScene, String> {
    of_file(&usda(), region, more, shown)
}

#[test]
fn imported_hair_belongs_to_regions_by_its_prims_and_its_attributes() {
    for (region, expected) in [
        ("groups = [\"fringe\"]", [1.0, 1.0, 0.0, 0.0]),
        ("groups = [\"back\", \"fringe\"]", [1.0; 4]),
        ("attribute = \"painted\"", [0.25, 1.0, 0.25, 1.0]),
        ("attribute = \"at_points\"", [0.5, 0.0, 0.5, 0.0]),
        ("groups = [\"back\"]\nattribute = \"painted\"", [0.0, 0.0, 0.25, 1.0]),
        ("attribute = \"clump\"\nvalues = [7]", [0.0, 1.0, 0.0, 1.0]),
        ("attribute = \"clump\"\nvalues = [7, 3]\ngroups = [\"back\"]", [0.0, 0.0, 1.0, 1.0]),
        ("painted = [[6, 9, -2, 0.5], [6, 9, 2, 1]]\nwithin = 3", [0.5, 1.0, 0.0, 0.0]),
        ("painted = [[-6, 9, 2, 0.5]]\nwithin = 1\nsoft = 0\nattribute = \"painted\"", [0.0, 0.0, 0.0, 0.5]),
        ("groups = [\"back\"]\nattribute = \"painted\"\nnear = [-6, 9, 2]\nwithin = 1\nsoft = 0", [0.0, 0.0, 0.0, 1.0]),
    ] {
        for more in ["", "segments = 9"] {
            let built = imported(region, more, Shown::All).unwrap();
            assert_eq!(weights(&built), expected, "{region} {more}");
            // Of fewer strands, each belongs as it does in the whole.
            let few = imported(region, more, Shown::AtMost(2)).unwrap();
            let of_few: Vec<f64> = few.groom.ids.iter().map(|&id| expected[id as usize]).collect();
            assert_eq!(weights(&few), of_few, "{region} {more}");
        }
    }
}

#[test]
fn the_only_object_with_curves_is_a_group_of_all_hair_and_what_one_object_lacks_is_said() {
    let only = usda().split("def BasisCurves \"back\"").next().unwrap().to_owned();
    for region in ["groups = [\"fringe\"]", "groups = [\"/fringe\"]"] {
        assert_eq!(weights(&of_file(&only, region, "", Shown::All).unwrap()), [1.0; 2], "{region}");
    }
    let said = of_file(&only, "groups = [\"back\"]", "", Shown::All).map(|_| ()).unwrap_err();
    assert!(said.contains("no group of the hair; it has fringe"), "{said}");
    let half = usda().replacen("primvars:painted", "primvars:other", 1);
    let said = of_file(&half, "attribute = \"painted\"", "", Shown::All).map(|_| ()).unwrap_err();
    let line = "free.regions[0].attribute = \"painted\": the file has it, but it was not read: ";
    assert!(said.contains(line) && said.contains("only some of its objects"), "{said}");
}

/// A motion cache of other weights is of another motion; the name of a region is not part of the motion.
#[test]
fn weights_are_part_of_the_identity_of_a_motion() {
    let identity = |hair: &str, region: &str| of_file(hair, region, "", Shown::All).unwrap().identity().unwrap();
    let region = "attribute = \"painted\"";
    let repainted = usda().replace("[0.25, 1]", "[0, 1]");
    assert_ne!(usda(), repainted);
    assert_ne!(identity(&usda(), region), identity(&repainted, region));
    // The same weights on other strands.
    assert_ne!(identity(&usda().replace("[0.25, 1]", "[1, 0]"), region), identity(&repainted, region));
    assert_eq!(identity(&usda(), region), identity(&usda(), &format!("name = \"a\"\n{region}")));
    let by_place = "near = [6, 9, 2]";
    assert_eq!(identity(&usda(), by_place), identity(&repainted, by_place));
}

#[test]
fn groups_and_attributes_that_are_not_there_are_refused_with_those_that_are() {
    for (region, line) in [
        ("groups = [\"bangs\"]", "free.regions[0].groups = \"bangs\": no group of the hair; it has back, fringe"),
        (
            "attribute = \"nothing\"",
            "free.regions[0].attribute = \"nothing\": no attribute of the hair with one number per strand or point; it has ",
        ),
        (
            "attribute = \"word\"",
            "free.regions[0].attribute = \"word\": has words, but a weight is one number per strand or point",
        ),
        (
            "attribute = \"large\"",
            "free.regions[0].attribute = \"large\": is 1.5 at the root of strand 0 of 4, but must be 0 to 1: correct it in the file",
        ),
        (
            "painted = [[6, 9, -2, 2.0]]",
            "free.regions[0].painted[0] = [6.0, 9.0, -2.0, 2.0]: the fourth number is a weight, from 0 to 1",
        ),
        ("values = [3]\nnear = [6, 9, 2]", "free.regions[0].values = [3]: are values of an attribute: add attribute"),
        ("hold = 2", "free.regions[0].near is missing: give near, groups, attribute, map or painted"),
    ] {
        let said = imported(region, "", Shown::All).map(|_| ()).unwrap_err();
        assert!(said.contains(line), "{said}");
    }
    let said = imported("attribute = \"nothing\"", "", Shown::All).map(|_| ()).unwrap_err();
    assert!(said.contains("clump, large, painted; the head's mesh has none"), "{said}");
    let bare = "[motion]\nform = \"free\"\n[[free.regions]]\nattribute = \"painted\"\n[[force]]\nthrough = 3\nvector = [1, 0, 0]";
    let said = Scene::parse(bare, Path::new("s.toml"), &[]).unwrap().build(Shown::AtMost(9)).map(|_| ()).unwrap_err();
    assert!(said.to_string().contains("the hair has no attributes with one number per strand or point"), "{said}");
}

/// A map that is white where u is above a half.
fn half_white() -> image::GrayImage {
    image::GrayImage::from_fn(64, 64, |x, _| image::Luma([if x >= 32 { 255 } else { 0 }]))
}

/// A square head with texture coordinates: u goes from -z to z.
const PLATE: &str = "v -10 0 -10\nv 10 0 -10\nv 10 0 10\nv -10 0 10\nv 0 -12 0\nvt 0 0\nvt 0 1\nvt 1 1\nvt 1 0\nvt 0.5 0.5\n\
                     f 4/4 3/3 2/2 1/1\nf 1/1 2/2 5/5\nf 2/2 3/3 5/5\nf 3/3 4/4 5/5\nf 4/4 1/1 5/5\n";

/// The weights of eight strands that grow from a line along z on that head, and what is refused.
fn mapped(head: &str, more: &str, map: &image::GrayImage) -> Result<(Vec<f32>, Vec<f64>), String> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let z = |s: i32| -8.75 + 2.5 * s as f32;
    let points: Vec<String> = (0..8).flat_map(|s| [0, 4, 8].map(|y| format!("(2, {y}, {})", z(s)))).collect();
    let hair = format!(
        "#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = \"Y\"\n)\ndef BasisCurves \"hair\"\n{{\n    uniform token type = \
         \"linear\"\n    int[] curveVertexCounts = [3, 3, 3, 3, 3, 3, 3, 3]\n    point3f[] points = [{}]\n{more}\n}}\n",
        points.join(", ")
    );
    std::fs::write(at("hair.usda"), hair).unwrap();
    std::fs::write(at("head.obj"), head).unwrap();
    map.save(at("map.png")).unwrap();
    let text = "[motion]\nform = \"free\"\n[head]\nmesh = \"head.obj\"\nellipsoid = { center = [0, 0, 0], half_axes = [9, 9, 9] }\n\
                [hair]\nfile = \"hair.usda\"\nroot = \"first\"\n[[free.regions]]\nmap = \"map.png\"\nwind = 0.5\n\
                [[force]]\nthrough = 3\nvector = [-40, 0, 0]";
    let scene = Scene::parse(text, &at("s.toml"), &[]).map_err(|e| e.to_string())?;
    let built = scene.build(Shown::All).map_err(|e| e.to_string())?;
    Ok(((0..8).map(z).collect(), weights(&built)))
}

#[test]
fn a_painted_map_chooses_hair_by_the_skin_where_it_grows() {
    let (z, found) = mapped(PLATE, "", &half_white()).unwrap();
    let expected: Vec<f64> = z.iter().map(|&z| if z > 0.0 { 1.0 } else { 0.0 }).collect();
    assert_eq!(found, expected);
    // Half grey is half.
    let grey = image::GrayImage::from_pixel(3, 3, image::Luma([51]));
    let (_, found) = mapped(PLATE, "", &grey).unwrap();
    assert!(found.iter().all(|weight| (weight - 0.2).abs() < 1e-4), "{found:?}");
}

/// Curves that know their place on the skin are found there, wherever the skin's own coordinates are.
#[test]
fn the_roots_own_coordinates_come_first() {
    let uvs = "    texCoord2f[] primvars:st = [(0.9, 0.5), (0.1, 0.5), (0.9, 0.5), (0.1, 0.5), (0.9, 0.5), (0.1, 0.5), (0.9, \
               0.5), (0.1, 0.5)] ( interpolation = \"uniform\" )";
    assert_eq!(mapped(PLATE, uvs, &half_white()).unwrap().1, [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]);
}

#[test]
fn a_map_without_coordinates_is_refused() {
    let bare: String = PLATE.lines().filter(|line| !line.starts_with("vt")).fold(String::new(), |text, line| {
        let line = line.split(' ').map(|word| word.split('/').next().unwrap()).collect::<Vec<_>>().join(" ");
        text + &line + "\n"
    });
    let said = mapped(&bare, "", &half_white()).unwrap_err();
    assert!(
        said.contains(
            "free.regions[0].map = \"map.png\": neither the hair's roots nor the head's mesh have texture coordinates (UVs), \
             which a map needs: add them in the file, or use near, groups or attribute"
        ),
        "{said}"
    );
}

/// Grown hair has the coordinates of its head, and another map is another motion.
#[test]
fn grown_hair_finds_its_place_on_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[motion]\nform = \"free\"\n[hair]\nstrands = 400\n[[free.regions]]\nmap = \"map.png\"\nwind = 0.5\n[[force]]\n\
                through = 3\nvector = [-40, 0, 0]";
    let built = |map: &image::GrayImage| {
        map.save(folder.path().join("map.png")).unwrap();
        Scene::parse(text, &folder.path().join("s.toml"), &[]).unwrap().build(Shown::All).unwrap()
    };
    let first = built(&half_white());
    let found = weights(&first);
    let uvs = first.groom.hair.attributes.root_uv.as_ref().unwrap();
    for (weight, uv) in found.iter().zip(uvs) {
        // But for the border of a pixel.
        if (uv[0] - 0.5).abs() > 1.0 / 64.0 && (uv[0] - uv[0].round()).abs() > 1.0 / 64.0 {
            assert_eq!(*weight, f64::from(u8::from(uv[0].rem_euclid(1.0) > 0.5)), "{uv:?}");
        }
    }
    assert!(found.contains(&0.0) && found.contains(&1.0));
    let mut other = half_white();
    other.put_pixel(60, 3, image::Luma([0]));
    assert_ne!(first.identity().unwrap(), built(&other).identity().unwrap());
}

/// The square head without texture coordinates, whose vertices have these colours.
fn coloured(colours: [&str; 5]) -> String {
    let places = ["-10 0 -10", "10 0 -10", "10 0 10", "-10 0 10", "0 -12 0"];
    let vertices: String = places.iter().zip(colours).map(|(place, colour)| format!("v {place} {colour}\n")).collect();
    vertices + "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"
}

/// What a region by an attribute selects of hair in a file on such a head, strand by strand from -z to z.
fn by_colour(head: &str, region: &str, of_hair: &str) -> Result<(Vec<f32>, Vec<f64>), String> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let z = |s: i32| -8.75 + 2.5 * s as f32;
    let points: Vec<String> = (0..8).flat_map(|s| [0, 4, 8].map(|y| format!("(2, {y}, {})", z(s)))).collect();
    let hair = format!(
        "#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = \"Y\"\n)\ndef BasisCurves \"hair\"\n{{\n    uniform token type = \
         \"linear\"\n    int[] curveVertexCounts = [3, 3, 3, 3, 3, 3, 3, 3]\n    point3f[] points = [{}]\n{of_hair}\n}}\n",
        points.join(", ")
    );
    std::fs::write(at("hair.usda"), hair).unwrap();
    std::fs::write(at("head.obj"), head).unwrap();
    let text = format!(
        "[motion]\nform = \"free\"\n[head]\nmesh = \"head.obj\"\nellipsoid = {{ center = [0, 0, 0], half_axes = [9, 9, 9] }}\n\
         [hair]\nfile = \"hair.usda\"\nroot = \"first\"\n[[free.regions]]\n{region}\nwind = 0.5\n[[force]]\nthrough = 3\n\
         vector = [-40, 0, 0]"
    );
    let scene = Scene::parse(&text, &at("s.toml"), &[]).map_err(|e| e.to_string())?;
    let built = scene.build(Shown::All).map_err(|e| e.to_string())?;
    Ok(((0..8).map(z).collect(), weights(&built)))
}

/// Greys that rise linearly along z.
const RISING: [&str; 5] = ["0 0 0", "0 0 0", "1 1 1", "1 1 1", "0 0 0"];

#[test]
fn a_weight_that_is_linear_on_the_heads_mesh_is_linear_at_the_roots() {
    let head = coloured(RISING);
    for name in ["color", "color.g"] {
        let (z, found) = by_colour(&head, &format!("attribute = \"{name}\""), "").unwrap();
        for (z, weight) in z.iter().zip(&found) {
            let expected = f64::from(z + 10.0) / 20.0;
            assert!((weight - expected).abs() < 1e-5, "{name} at {z}: {weight}, not {expected}");
        }
    }
    // The same numbers on the hair itself make the same region.
    let of_hair: Vec<String> = (0..8).map(|s| format!("{}", (1.25 + 2.5 * s as f32) / 20.0)).collect();
    let of_hair = format!("    float[] primvars:mask = [{}] ( interpolation = \"uniform\" )", of_hair.join(", "));
    let (_, on_hair) = by_colour(&head, "attribute = \"mask\"", &of_hair).unwrap();
    let (_, on_head) = by_colour(&head, "attribute = \"color\"", "").unwrap();
    assert!(on_hair.iter().zip(&on_head).all(|(a, b)| (a - b).abs() < 1e-5), "{on_hair:?} {on_head:?}");
}

#[test]
fn numbers_of_parts_on_the_heads_mesh_are_not_mixed() {
    let head = coloured(["3 3 3", "3 3 3", "7 7 7", "7 7 7", "5 5 5"]);
    let (z, found) = by_colour(&head, "attribute = \"color\"\nvalues = [7, 9]", "").unwrap();
    // The corner with the largest share decides: at x = 2, those with 7 have it from z = 2 on.
    let expected: Vec<f64> = z.iter().map(|&z| f64::from(u8::from(z > 2.0))).collect();
    assert_eq!(found, expected);
    let (_, none) = by_colour(&head, "attribute = \"color\"\nvalues = [4, 5, 6]", "").unwrap();
    assert_eq!(none, [0.0; 8]);
}

#[test]
fn weights_of_the_head_that_are_not_there_or_none_are_refused() {
    let head = coloured(["2 2 2"; 5]);
    let said = by_colour(&head, "attribute = \"color\"", "").unwrap_err();
    let line = "free.regions[0].attribute = \"color\": is 2 on the head's mesh at the root of strand 0 of 8, but must be 0 to 1: \
                correct it in its file";
    assert!(said.contains(line), "{said}");
    let said = by_colour(&head, "attribute = \"fringe\"", "").unwrap_err();
    let line = "free.regions[0].attribute = \"fringe\": the hair has no attributes with one number per strand or point, and the \
                head's mesh has color";
    assert!(said.contains(line), "{said}");
}

/// Hair that is grown has the weights of its head, and another painting is another motion.
#[test]
fn grown_hair_belongs_by_the_colours_of_its_head() {
    let folder = tempfile::tempdir().unwrap();
    let built = |blue: f32, region: &str| {
        std::fs::write(folder.path().join("head.obj"), ball(blue)).unwrap();
        let text = format!(
            "[motion]\nform = \"free\"\n[head]\nmesh = \"head.obj\"\nellipsoid = {{ center = [0, 0, 0], half_axes = [9, 9, 9] }}\n\
             [hair]\nstrands = 200\n[[free.regions]]\n{region}\nwind = 0.5\n[[force]]\nthrough = 3\nvector = [-40, 0, 0]"
        );
        Scene::parse(&text, &folder.path().join("s.toml"), &[]).unwrap().build(Shown::All).unwrap()
    };
    let red = "attribute = \"color.r\"";
    let first = built(0.0, red);
    for (strand, weight) in first.strands().iter().zip(weights(&first)) {
        let expected = f64::from((strand[0].x + 9.0) / 18.0);
        assert!((weight - expected).abs() < 0.01, "{}: {weight}, not {expected}", strand[0]);
    }
    let blue = "attribute = \"color.b\"";
    let identity = |of: f32, region: &str| built(of, region).identity().unwrap();
    assert_ne!(identity(0.25, blue), identity(0.5, blue));
    assert_eq!(identity(0.25, red), identity(0.5, red));
    assert_eq!(identity(0.25, blue), identity(0.25, blue));
}

/// A ball of 9 cm whose red rises linearly from 0 to 1 along x, with as much blue everywhere.
fn ball(blue: f32) -> String {
    const RINGS: usize = 24;
    const AROUND: usize = 48;
    let mut text = String::new();
    let mut vertex = |turn: f32, across: f32| {
        let (height, radius) = (9.0 * across.cos(), 9.0 * across.sin());
        let (x, z) = (radius * turn.cos(), radius * turn.sin());
        writeln!(text, "v {x} {height} {z} {} 0 {blue}", ((x + 9.0) / 18.0).clamp(0.0, 1.0)).unwrap();
    };
    vertex(0.0, 0.0);
    for ring in 1..RINGS {
        for i in 0..AROUND {
            let of = |k: usize, n: usize| k as f32 / n as f32 * std::f32::consts::PI;
            vertex(2.0 * of(i, AROUND), of(ring, RINGS));
        }
    }
    vertex(0.0, std::f32::consts::PI);
    let at = |ring: usize, i: usize| 2 + (ring - 1) * AROUND + i % AROUND;
    let last = 2 + (RINGS - 1) * AROUND;
    for i in 0..AROUND {
        writeln!(text, "f 1 {} {}\nf {last} {} {}", at(1, i + 1), at(1, i), at(RINGS - 1, i), at(RINGS - 1, i + 1))
            .unwrap();
        for ring in 1..RINGS - 1 {
            let [a, b, c, d] = [at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)];
            writeln!(text, "f {a} {b} {c} {d}").unwrap();
        }
    }
    text
}

//! Text in scenes: units and numbers as they are read or refused, rigid motions in words, and
//! overrides that have no place.

use ancf::scene::{Scene, parse};

/// A clamped arm with something in the place of its stiffness against bending or stretch.
fn arm(axial: &str, bending: &str) -> String {
    format!(
        "beam.arm = {{ start = [0, 0], end = [1.8, 0], axial_stiffness = {axial}, bending_stiffness = {bending}, basis.ancf.elements = 3 }}
         support = [{{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }}]
         analysis.static = {{}}\n"
    )
}

/// What the message about a bending stiffness of two of these says, be it the dimension or why it
/// is no unit.
#[test]
fn units_are_told_by_their_dimension_or_what_is_wrong() {
    let power = "a whole power such as `^2` was expected after `^`";
    let product = "a product after `/` can be read in two ways: write `kg/(m s)`, `kg/m/s` or `kg/m*s`";
    for (unit, told) in [
        ("m^12", "whose dimension is m^12, not kg m^3 s^-2;"),
        ("m^-12", "whose dimension is m^-12,"),
        ("m^13", "the power `13` is not a whole number within ±12"),
        ("m^-13", "the power `-13` is not a whole number within ±12"),
        ("m^0", "whose dimension is 1,"),
        ("m²", "whose dimension is m^2,"),
        ("m⁻²", "whose dimension is m^-2,"),
        ("m¹²", "whose dimension is m^12,"),
        ("m**2", "whose dimension is m^2,"),
        ("m^2s", "whose dimension is m^2 s,"),
        ("1/m", "whose dimension is m^-1,"),
        ("1/(m s)", "whose dimension is m^-1 s^-1,"),
        ("1/ m", "whose dimension is m^-1,"),
        ("m / s", "whose dimension is m s^-1,"),
        ("m * m", "whose dimension is m^2,"),
        ("m·m", "whose dimension is m^2,"),
        ("m⋅m", "whose dimension is m^2,"),
        ("m  m", "whose dimension is m^2,"),
        ("kg/m*s", "whose dimension is kg m^-1 s,"),
        ("kg/m/s", "whose dimension is kg m^-1 s^-1,"),
        ("N m^2 °", "whose dimension is kg m^3 s^-2 rad,"),
        ("min^2", "whose dimension is s^2,"),
        ("dag", "whose dimension is kg,"),
        ("m^12 m^12 m", "whose dimension is m^25,"),
        ("(((m^12)^12)^12)^12 m", "whose dimension is m^20737,"),
        ("((((m^12)^12)^12)^12)^12", "its powers are too large"),
        ("((((((((m^2))))))))", "whose dimension is m^2,"),
        ("(((((((((m^2)))))))))", "its brackets are nested too deeply"),
        ("m^", power),
        ("m^ 2", power),
        ("m^x", power),
        ("m**", power),
        ("m^-", "the power `-` is not a whole number"),
        ("m^2-3", "a unit was expected where `-` stands"),
        ("m^2^2", "a unit was expected where `^` stands"),
        ("m^1.5", "a unit was expected where `.` stands"),
        ("m ^2", "a unit was expected where `^` stands"),
        ("m//s", "a unit was expected where `/` stands"),
        ("/s", "a unit was expected where `/` stands"),
        ("()", "a unit was expected where `)` stands"),
        ("m*", "a unit is missing at its end"),
        ("(m", "a bracket is not closed"),
        ("m)", "`)` in the unit `m)` has no meaning there"),
        ("kg/m s", product),
        ("kg m^3/(s^2 N) m", product),
        ("km2", "powers are written with `^`: `km^2`"),
        ("m-2", "powers are written with `^`: `m^-2`"),
        ("kNmm", "`kNmm` is no unit; a product is written with a space: `kN mm`"),
        ("Kg", "`Kg` is no unit known here; there are m, g, s,"),
        ("kkm", "`kkm` is no unit known here;"),
        ("kmin", "`kmin` is no unit; a product is written with a space: `km in`"),
        ("klb", "`klb` is no unit known here;"),
        ("m_", "`m_` is no unit known here;"),
        ("%", "`%` is no unit known here;"),
    ] {
        let text = arm("1e4", &format!("\"2 {unit}\""));
        let error = parse("scene.toml", &text).err().unwrap_or_else(|| panic!("{unit} is legal")).to_string();
        assert!(
            error.starts_with(&format!("scene.toml:1:89: `beam.arm.bending_stiffness`: found \"2 {unit}\"")),
            "{error}"
        );
        assert!(error.contains(told), "{told}: {error}");
    }
    for unit in ["N m^2", " N  m^2", "N·m²", "kg m^3 s^-2", "(kg m^3)/(s^2)", "kg m^3/s/s", "kg*m**3/s²"] {
        let scene =
            parse("scene.toml", &arm("1e4", &format!("\"2 {unit}\""))).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(scene.model().beams[0].section.bending_stiffness, Some(2.0.into()), "{unit}");
    }
}

/// Numbers in every spelling, before their unit.
#[test]
fn numbers_before_units_are_read_in_every_spelling() {
    for (text, value) in [
        ("2. N", 2.0),
        (".5 N", 0.5),
        ("+3 N", 3.0),
        ("1e3N", 1e3),
        ("2.5E+3 N", 2.5e3),
        ("2.5e-1 N", 0.25),
        ("1.e2 N", 100.0),
        (" 4 N ", 4.0),
        ("5kN", 5e3),
        ("007 N", 7.0),
    ] {
        let scene = parse("scene.toml", &arm(&format!("\"{text}\""), "2")).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(scene.model().beams[0].section.axial_stiffness, Some(value.into()), "{text}");
    }
    let no_number = "it does not begin with a decimal number";
    for (text, told) in [
        (".", no_number),
        ("-", no_number),
        ("e5 N", no_number),
        ("- 3 N", no_number),
        ("nan", no_number),
        ("", no_number),
        ("7eN", "`eN` is no unit known here"),
        ("3e400 N", "`3e400` is beyond the largest number, 1.8e308"),
        ("3", "write 3 without quotation marks for N, or \"3 N\""),
        ("-3 N", "found \"-3 N\", expected a positive force: a number in N, or text"),
        ("0 N", "found \"0 N\", expected a positive force"),
        ("1e308 TN", "; it must be finite"),
    ] {
        let error = parse("scene.toml", &arm(&format!("\"{text}\""), "2")).expect_err(text).to_string();
        assert!(error.contains(told), "{told}: {error}");
    }
}

/// Columns are counted in letters, also behind letters of several bytes.
#[test]
fn columns_are_counted_in_letters() {
    let text = arm("1e4", "2") + "# ünïcode\nprobe = [{ name = \"µ°²\", beam = \"arn\", at = 0 }]\n";
    let error = parse("scene.toml", &text).expect_err("no such beam");
    assert_eq!(error.place(), Some(("scene.toml", 5, 33)));
    assert!(error.to_string().contains("did you mean `arm`? beams of this scene: arm"), "{error}");
}

/// A structure that can move, and how: would catch the other axis, a point in other units, the
/// stiffer beam, and springs and weight that hold nothing.
#[test]
fn rigid_motions_are_told_in_words() {
    let beam = |name: &str, start: [f64; 2], end: [f64; 2]| {
        format!(
            "beam.{name} = {{ start = {start:?}, end = {end:?}, axial_stiffness = 1e4, bending_stiffness = 1, mass_per_length = 1, \
             basis.ancf.elements = 2 }}\n"
        )
    };
    let held = |supports: &str| format!("support = [{supports}]\n");
    let at = |place: &str, fix: &str| format!("{{ beam = 'a', at = {place}, fix = {fix} }}");
    let (level, upright) = (beam("a", [1.0, 2.0], [3.0, 2.0]), beam("a", [1.0, 2.0], [1.0, 4.0]));
    let hinged = level.clone() + &held(&at("'start'", "['x', 'y']"));
    let slider = |along: &str| {
        let slider =
            format!("{{ type = 'slider', first = {{ beam = 'a', at = 'start' }}, along = {along} }}");
        format!("{level}joint = [{slider}]\n{}", held(&at("'end'", "['angle']")))
    };
    let two = level.clone()
        + &beam("b", [3.0, 2.0], [3.0, 7.0])
        + &held(&at("'start'", "['x', 'y', 'angle']"))
        + "joint = [{ type = 'hinge', first = { beam = 'a', at = 'end' }, second = { beam = 'b', at = 'start' } }]\n";
    let turn = "beam `a` is under-supported: it is free for rotation about the point (1, 2)";
    for (text, told) in [
        (slider("[4, 3]"), Some("beam `a` is under-supported: it is free for translation along (1, 0.75)")),
        (slider("[0, -3]"), Some("it is free for translation along y")),
        (slider("[2, 0]"), Some("it is free for translation along x")),
        (
            upright.clone() + &held(&at("0.5", "['x', 'y']")),
            Some("it is free for rotation about the point (1, 2.5)"),
        ),
        (
            level.clone() + &held(&format!("{}, {}", at("'start'", "['x']"), at("'end'", "['y']"))),
            Some("it is free for rotation about the point (3, 2)"),
        ),
        (
            level.clone() + &held(&at("'start'", "['x']")),
            Some("it is free for translation along y and rotation about the point (1, 2)"),
        ),
        (
            level.clone(),
            Some(
                "it is free for translation along x, translation along y and rotation about the point (1, 2)",
            ),
        ),
        (two, Some("beam `b` is under-supported: it is free for rotation about the point (3, 2)")),
        (hinged.clone(), Some(turn)),
        (hinged.clone() + "effect.force = [{ beam = 'a', at = 'end', value = [1, 1] }]\n", Some(turn)),
        (hinged.clone() + "effect.gravity.acceleration = [0, 0]\n", Some(turn)),
        (
            hinged.clone() + "effect.gravity = { acceleration = [0, -9.81], in_time.step.start = 1 }\n",
            Some(turn),
        ),
        (hinged.clone() + "effect.gravity.acceleration = [0, -9.81]\n", None),
        (hinged.clone() + "effect.gravity.acceleration = [2, 0]\n", None),
        (hinged.clone() + "effect.torsion_spring = [{ beam = 'a', at = 'start', stiffness = 1 }]\n", None),
        (hinged.clone() + "effect.spring = [{ beam = 'a', at = 'end', stiffness = 1 }]\n", None),
        (hinged.clone() + "effect.foundation = [{ beam = 'a', stiffness = [0, 1] }]\n", None),
        (hinged.replace("bending_stiffness = 1, ", ""), None),
        (
            hinged.clone()
                + "effect.contact = [{ beam = 'a', stiffness = 1e4, half_plane = { point = [0, 1], normal = [0, 1] } }]\n",
            Some("an obstacle does not count, for it holds what presses it only"),
        ),
        (
            (level.clone() + &held(&at("'start'", "['x']"))).replace("bending_stiffness = 1, ", ""),
            Some("it is free for translation along y\n"),
        ),
    ] {
        let found = parse("scene.toml", &(text.clone() + "analysis.static = {}\n"));
        match (found, told) {
            (Ok(_), None) => {}
            (Err(error), Some(told)) => {
                assert!(error.to_string().contains(told), "{told}: {error}");
                let help = "an equilibrium needs every rigid motion held: add a `[[support]]`";
                assert!(error.to_string().contains(help), "{error}");
            }
            (Ok(_), Some(told)) => panic!("legal, and not {told}:\n{text}"),
            (Err(error), None) => panic!("{error}\n{text}"),
        }
        // A motion needs nothing held.
        let motion = "analysis.dynamic = { duration = 1 }\n";
        assert!(parse("scene.toml", &(text.clone() + motion)).is_ok(), "{text}");
    }
}

fn scene() -> Scene {
    let loads =
        "effect.moment = [{ beam = 'arm', at = 'end', value = 1 }, { beam = 'arm', at = 1, value = 2 }]\n";
    parse("scene.toml", &(arm("1e4", "2") + loads)).expect("a legal scene")
}

/// What is wrong with an override, at which column of it, and what to write.
#[test]
fn overrides_without_a_place_are_told() {
    for (options, place, told, help) in [
        (
            &["effect.moment.2.value=1"][..],
            1,
            "`effect.moment` is a list and has no entry `2`",
            "its entries are 0 to 1",
        ),
        (&["effect.moment.x.value=1"], 1, "has no entry `x`", "its entries are 0 to 1"),
        (&["support.1.fix=['x']"], 1, "`support` is a list and has no entry `1`", "its only entry is 0"),
        (&["probe=[]", "probe.0.name=x"], 1, "`probe` is a list and has no entry `0`", "the list is empty"),
        (
            &["effect.tendon.0.tension=1"],
            1,
            "the scene has no `effect.tendon`, of which this would be number 0",
            "write `[[effect.tendon]]` into the scene",
        ),
        (&["beam.leg.start=[0, 0]"], 1, "`beam` has no `leg`", "it has: arm"),
        (
            &["beam.leg={ start = [0, 0], end = [1, 1], axial_stiffness = 1, basis.ancf.elements = 1 }"],
            1,
            "`beam` has no `leg`",
            "it has: arm",
        ),
        (
            &["beam.arm.axial_stiffness.x=1"],
            1,
            "`beam.arm.axial_stiffness` is a float, so `x` cannot be set in it",
            "set `beam.arm.axial_stiffness` itself, or check the path",
        ),
        (&["=3"], 1, "`` is not a path of keys joined by dots", "such as --set beam.arm"),
        (&["title"], 1, "expected PATH=VALUE, found no `=`", "such as --set beam.arm"),
        (&["support.0.fix=[]"], 15, "this support fixes nothing", "name some of"),
        (
            &["title=x", "beam.arm.basis.ancf.elements=0"],
            30,
            "found 0, expected a whole number, 1 or more",
            "",
        ),
        (
            &["beam.arm.basis.ancf.elements=0", "title=x"],
            30,
            "found 0, expected a whole number, 1 or more",
            "",
        ),
        // What comes later moves the text about, and is not to blame.
        (
            &["effect.damping=[{ mass_proportional = 1 }]", "probe=[]"],
            16,
            "missing key `beam` in `effect.damping.0`",
            "add `beam = …`",
        ),
        (
            &["effect.moment.1.value=1 m"],
            23,
            "`effect.moment.1.value`: found \"1 m\", whose dimension is m",
            "",
        ),
    ] {
        let overrides: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        let error = scene().with(&overrides).expect_err("no place for it");
        assert_eq!(error.place(), Some(("--set", 1, place)), "{error}");
        let blamed = options.iter().find(|option| !option.starts_with("title=") && **option != "probe=[]");
        let message = error.to_string();
        assert!(message.contains(told) && message.contains(help), "{told}: {message}");
        assert!(message.contains(&format!("(in the override `{}`)", blamed.expect("one"))), "{message}");
    }
}

/// Overrides of entries and of keys that were not there; several in turn, each on what the one
/// before has made.
#[test]
fn overrides_in_turn_build_on_each_other() {
    let with = |options: &[&str]| {
        let options: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        scene().with(&options).unwrap_or_else(|error| panic!("{error}"))
    };
    let found = with(&["probe=[{ name = 'a', beam = 'arm', at = 0 }]", "probe.0.name=tip", "probe.0.at=end"]);
    let probe = &found.model().probes[0];
    assert_eq!((found.model().probes.len(), probe.name.as_str(), probe.at.s), (1, "tip", 1.8));
    let found = with(&["output.vtu=true", "output.states=true", "title=two words", "beam.arm.end.0=2"]);
    assert_eq!((found.output().vtu, found.output().states), (true, true));
    assert_eq!((found.model().title.as_str(), scene().model().title.as_str()), ("two words", ""));
    let analysis = with(&["analysis.static.steps=3"]);
    let same =
        parse("scene.toml", &analysis.text().replace("steps = 3", "steps = 3 ")).expect("its own text");
    assert_eq!((same.model(), same.analysis()), (analysis.model(), analysis.analysis()));
    assert_ne!(analysis.analysis(), scene().analysis());
}

/// `*` stands for every entry of a table or a list, also twice in a path and beside names that need quotes.
#[test]
fn a_star_sets_every_entry() {
    let text = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1, bending_stiffness = 1, basis.ancf.elements = 2 }\n\
                beam.'second arm' = { start = [1, 0], end = [2, 0], axial_stiffness = 2, bending_stiffness = 2, basis.rpim.nodes = 4 }\n\
                joint = [{ type = 'weld', first = { beam = 'arm', at = 'end' }, second = { beam = 'second arm', at = 'start' } }]\n\
                support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }, { beam = 'second arm', at = 'end', fix = ['x', 'y'] }]\n\
                effect.force = [{ beam = 'arm', at = 'end', value = [1, 1] }, { beam = 'second arm', at = 'end', value = [2, 2] }]\n\
                analysis.static = {}\n";
    let scene = parse("two.toml", text).expect("a scene");
    let with = |options: &[&str]| {
        let options: Vec<String> = options.iter().map(|option| (*option).to_owned()).collect();
        scene.with(&options)
    };
    for (stars, single) in [
        (
            &["beam.*.basis={ ancf = { elements = 7 } }"][..],
            &[
                "beam.arm.basis={ ancf = { elements = 7 } }",
                "beam.'second arm'.basis={ ancf = { elements = 7 } }",
            ][..],
        ),
        (
            &["effect.force.*.value.*=5", "beam.arm.strain=green"],
            &[
                "effect.force.0.value.0=5",
                "effect.force.0.value.1=5",
                "effect.force.1.value.0=5",
                "effect.force.1.value.1=5",
                "beam.arm.strain=green",
            ],
        ),
        (&["title=a.*=b"], &["title=\"a.*=b\""]),
    ] {
        let [stars, single] =
            [stars, single].map(|options| with(options).unwrap_or_else(|error| panic!("{error}")));
        assert_eq!((stars.model(), stars.text()), (single.model(), single.text()));
    }
    for (option, column, told) in [
        ("probe.*.at=0", 7, "`probe` has no entries for which `*` could stand"),
        ("beam.arm.start.0.*=0", 18, "`beam.arm.start.0` has no entries for which `*` could stand"),
        ("beam.*.basis.ancf.elements=0", 28, "beam.arm.basis.ancf.elements=0"),
    ] {
        let error = with(&[option]).map(drop).expect_err(option);
        let (_, _, found) = error.place().expect("a place");
        let text = error.to_string();
        assert!(text.contains(told), "{text}");
        assert!(found == column || option.starts_with("beam.*"), "{found}: {text}");
    }
}

/// A value is what the scene says at its path, as its overrides write it.
#[test]
fn values_are_read_by_the_paths_that_set_them() {
    let scene = scene();
    let value = |path: &str| scene.value(path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(value("beam.arm.end.0"), Some(serde_json::json!(1.8)));
    assert_eq!(value("support.0.fix"), Some(serde_json::json!(["x", "y", "angle"])));
    assert_eq!(
        [value("beam.arm.height"), value("support.1"), value("support.x"), value("title.x")],
        [const { None }; 4]
    );
    assert!(scene.value("a..b").expect_err("no path").to_string().contains("not a path"));
}

/// Parts that are added by code act, are told where the text is written for others, and go to
/// another scene when asked to.
#[test]
fn parts_added_by_code_are_not_in_the_text() {
    let open = "beam.arm = { start = [0, 0], end = [1, 0], axial_stiffness = 1e6, bending_stiffness = 2 }
        support = [{ beam = 'arm', at = 'start', fix = ['x', 'y', 'angle'] }]
        probe = [{ name = 'tip', beam = 'arm', at = 'end' }]\nanalysis.static.accuracy = 1e-4\n";
    let read = || parse("scene.toml", open).unwrap_or_else(|error| panic!("{error}"));
    let angle = |scene: &Scene| {
        let solved =
            ancf::accuracy::run(scene, ancf::Options::default()).unwrap_or_else(|error| panic!("{error}"));
        let chosen = solved
            .run()
            .error
            .as_ref()
            .and_then(|error| error.chosen.as_deref().map(str::to_owned))
            .unwrap_or_default();
        (solved.states().probes[0].samples.last().map_or(f64::NAN, |tip| tip.angle), chosen)
    };
    let mut added = read();
    added.add(ancf::effect::Moment::new(ancf::Place::new(0, 1.0), 3.0));
    let mut other = read();
    other.add_parts_of(&added);
    for scene in [&added, &other] {
        let (turned, chosen) = angle(scene);
        // M L/EI
        assert!((turned - 1.5).abs() < 1e-4, "{turned}");
        assert!(
            chosen.starts_with("# Without what was added to the scene by code: 1 of its parts.\n"),
            "{chosen}"
        );
    }
    let (straight, chosen) = angle(&read());
    assert!(straight.abs() < 1e-12 && !chosen.contains('#'), "{straight}, {chosen}");
}

//! Two thousand commands in an order that nobody would choose: the window stays consistent.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use fragscale::app::command::{Asking, Choice, PictureRequest, Tab, ViewChange};
use fragscale::app::linked::PointFrom;
use fragscale::app::open_flight::survey::{BaseChoice, SurveyStep, SurveyTool};
use fragscale::app::open_flight::table::SortBy;
use fragscale::app::open_flight::tracing::Trace;
use fragscale::app::open_flight::{Measure, OpenFlight};
use fragscale::app::state::layers::Layers;
use fragscale::app::state::preferences::Theme;
use fragscale::app::tasks::Task;
use fragscale::app::{Command, State};
use fragscale::exports::PHOTO_COLUMNS;
use fragscale::flight::{Along, DecisionKind, FlightSettings, Limits, Outcome, Verdict};
use fragscale::geometry::Ray;
use fragscale::render::{ColorBy, Scope};
use fragscale::scale::{Ground, ImageKind, ScaleObjectKind, ScalePair};
use fragscale::split_mix::SplitMix;
use fragscale::units::LengthUnit;
use glam::{DVec2, DVec3};

use crate::desk::{Desk, copy, copy_files, flight};

/// A sequence that is the same every time.
pub struct Dice(SplitMix);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(SplitMix(seed))
    }

    fn next(&mut self) -> u64 {
        self.0.next()
    }

    /// Below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.unit()
    }

    fn coin(&mut self) -> bool {
        self.below(2) == 0
    }

    pub fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }
}

/// Where files may be read and written.
struct Places {
    flights: Vec<PathBuf>,
    broken: Vec<PathBuf>,
    output: PathBuf,
}

fn ray(dice: &mut Dice) -> Ray {
    let origin = DVec3::new(
        dice.between(-2.0, 2.0),
        dice.between(-2.0, 2.0),
        dice.between(0.5, 3.0),
    );
    let to = DVec3::new(dice.between(-1.8, 1.8), dice.between(-1.4, 1.4), 0.0);
    Ray {
        origin,
        direction: (to - origin).normalize(),
    }
}

fn settings(dice: &mut Dice, now: FlightSettings) -> FlightSettings {
    let mut next = now;
    match dice.below(8) {
        0 => next.unit = dice.one_of(&LengthUnit::ALL),
        1 => next.ground = Ground::Auto,
        2 => next.ground = Ground::At(dice.between(-1.0, 1.0)),
        3 => next.image = dice.one_of(&[ImageKind::Undistorted, ImageKind::AsShot]),
        6 => next.pair = dice.one_of(&[ScalePair::Fitted, ScalePair::Corners]),
        7 => next.errors.surface = dice.coin().then(|| dice.between(0.0, 0.1)),
        4 => next.surface.max_edge = dice.coin().then(|| dice.between(0.001, 1.0)),
        _ => next.surface.thinning = dice.coin().then(|| dice.between(0.05, 0.5)),
    }
    next
}

/// Bars more than spheres: they are done after two points.
fn trace(dice: &mut Dice) -> Trace {
    let kind = dice.one_of(&[ScaleObjectKind::Sphere, ScaleObjectKind::Bar]);
    let pixel =
        |dice: &mut Dice| DVec2::new(dice.between(-50.0, 1300.0), dice.between(-50.0, 800.0));
    match dice.below(12) {
        0 | 1 => Trace::Size(kind, dice.one_of(&[0.06, 1.0, 0.0, -1.0, f64::NAN])),
        2 | 3 => Trace::Begin(kind),
        4..=8 => Trace::Add(pixel(dice)),
        9 => Trace::Move(dice.below(5), pixel(dice)),
        10 => dice.one_of(&[Trace::RemoveLast, Trace::RemoveAll]),
        _ => dice.one_of(&[Trace::Finish, Trace::GiveUp]),
    }
}

fn view_change(dice: &mut Dice) -> ViewChange {
    let pixels =
        |dice: &mut Dice| DVec2::new(dice.between(-50.0, 900.0), dice.between(-50.0, 600.0));
    let size = DVec2::new(dice.between(1.0, 2000.0), dice.between(1.0, 1000.0));
    match dice.below(13) {
        0 => ViewChange::Orbit(pixels(dice)),
        1 => ViewChange::Pan(pixels(dice), size),
        2 | 3 => ViewChange::Zoom {
            cursor: pixels(dice),
            size,
            factor: dice.one_of(&[0.1, 0.9, 1.1, 10.0, 0.0, 1e9]),
        },
        4 => ViewChange::Resized(size),
        5 => ViewChange::Top,
        6 => ViewChange::Front,
        7 => ViewChange::Side,
        8 => dice.one_of(&[ViewChange::Fit, ViewChange::FitAll]),
        9 => ViewChange::FitSelected,
        10 => ViewChange::Center(ray(dice).at(1.0)),
        11 => ViewChange::Through,
        _ => ViewChange::Blend(dice.between(-1.0, 2.0)),
    }
}

fn layers(dice: &mut Dice, now: Layers) -> Layers {
    let scope = dice.one_of(&[Scope::None, Scope::Selected, Scope::All]);
    let color_by = dice.one_of(&[
        ColorBy::Rgb,
        ColorBy::Elevation,
        ColorBy::Slope,
        ColorBy::Scale,
    ]);
    Layers {
        cloud: dice.coin(),
        mesh: dice.coin(),
        color_by,
        fills: scope,
        orthographic: dice.coin(),
        ..now
    }
}

/// Any command but those that leave the program, wait for the desktop's dialog, or open the bundled
/// flight: it would be saved where it lies.
fn command(dice: &mut Dice, state: &State, places: &Places) -> Command {
    let now = state.open.as_ref().map(|open| open.settings());
    let photos = 11;
    match dice.below(100) {
        0 => Command::Open(
            dice.one_of(&places.flights.iter().collect::<Vec<_>>())
                .clone(),
        ),
        1 => Command::Open(
            dice.one_of(&places.broken.iter().collect::<Vec<_>>())
                .clone(),
        ),
        3 if dice.below(4) == 0 => Command::Close,
        4 => Command::Save,
        5 => Command::SaveAs(
            places
                .output
                .join(format!("flight-{}.toml", dice.below(3)))
                .into(),
        ),
        6 => Command::Export(
            places
                .output
                .join(format!("export-{}", dice.below(2)))
                .into(),
        ),
        7 => Command::Picture(PictureRequest {
            to: places.output.join("figure.png").into(),
            size: [64, 48],
            transparent: dice.coin(),
            corner_rays: dice.coin(),
        }),
        8 | 9 => Command::Ask(dice.one_of(&[
            None,
            Some(Asking::Open),
            Some(Asking::Export),
            Some(Asking::SaveAs),
            Some(Asking::Picture),
            Some(Asking::Keys),
            Some(Asking::About),
        ])),
        10 | 11 => Command::Cancel(dice.one_of(&[
            Task::OPEN,
            Task::SCALES,
            Task::VIEWS,
            Task::GEOMETRY,
            Task::THUMBNAILS,
            Task::PREVIEW,
            Task::EXPORT,
            Task::SAVE,
            Task::PICTURE,
        ])),
        12 => Command::Discard,
        13 => Command::Keep,
        14 => Command::SaveFirst,
        15..=20 => Command::Select(dice.coin().then(|| dice.below(photos))),
        21..=26 => Command::SelectBy(dice.one_of(&[-1, 1, -3, 5, i32::MIN, i32::MAX])),
        27..=30 => Command::Click(ray(dice)),
        31..=33 => {
            let from = dice.one_of(&[PointFrom::Pile, PointFrom::Photo, PointFrom::Inspector]);
            Command::Hover(from, dice.coin().then(|| ray(dice)))
        }
        34 | 35 => Command::DoubleClick(ray(dice)),
        36 | 37 => Command::HoverPhoto(dice.coin().then(|| dice.below(photos))),
        38..=42 => Command::Choose(dice.below(photos), dice.coin()),
        43 | 44 => {
            Command::ChooseAll(dice.one_of(&[Choice::WithScale, Choice::Trusted, Choice::None]))
        }
        45..=49 => {
            let columns = PHOTO_COLUMNS.iter().map(SortBy::Column);
            let all: Vec<SortBy> = columns.chain([SortBy::Flight, SortBy::Export]).collect();
            Command::Sort(dice.one_of(&all))
        }
        50 | 51 => Command::Filter(
            dice.one_of(&["", "", "000", "img_0005", "scale", "¿"])
                .into(),
        ),
        52 | 53 => {
            let verdicts = Verdict::ALL.map(Some);
            let verdict = dice.one_of(&verdicts);
            Command::FilterVerdict(verdict.filter(|_| dice.coin()))
        }
        54..=61 => now.map_or(Command::Tab(Tab::Flight), |now| {
            Command::Set(settings(dice, now))
        }),
        62..=67 => Command::Undo,
        68..=71 => Command::Redo,
        72 => Command::Unit(dice.one_of(&LengthUnit::ALL)),
        73 | 74 => Command::Limits(if dice.coin() {
            Limits::default()
        } else {
            Limits {
                top_bottom_ratio: dice.between(1.0, 1.3),
                flattest_angle: dice.between(0.0, 90.0),
                ..Limits::default()
            }
        }),
        75 => Command::Layers(layers(dice, state.preferences.layers)),
        76 => Command::Theme(dice.one_of(&[Theme::System, Theme::Light, Theme::Dark])),
        77 => Command::Zoom(dice.one_of(&[0.0, 1.0, 1.25, 2.0, 9.0])),
        78..=80 => Command::Tab(dice.one_of(&[Tab::Photo, Tab::Flight, Tab::Limits])),
        81 => match dice.below(3) {
            0 => Command::ToggleLog,
            1 => Command::ToggleLeft,
            _ => Command::ToggleRight,
        },
        82 | 83 => Command::DismissNotice,
        84 | 85 => {
            let kinds = [DecisionKind::Accepted, DecisionKind::LeftOut];
            let decided = (dice.one_of(&kinds), "why\n so".to_owned());
            Command::Decide(dice.below(photos), dice.coin().then_some(decided))
        }
        86..=91 => Command::View(view_change(dice)),
        92..=94 => Command::Trace(trace(dice)),
        95 => Command::ToggleMeasure,
        96 => Command::Survey(survey_step(dice)),
        97 if dice.coin() => Command::ToggleTint,
        97 => Command::CopyScales,
        98 => Command::Copy("text".to_owned()),
        _ => Command::Report("told\nin two lines".to_owned()),
    }
}

fn survey_step(dice: &mut Dice) -> SurveyStep {
    let tools = [SurveyTool::Profile, SurveyTool::Volume];
    let bases = [
        BaseChoice::Rim,
        BaseChoice::Height(0.1),
        BaseChoice::Height(f64::NAN),
    ];
    match dice.below(7) {
        0 | 1 => SurveyStep::Toggle(dice.one_of(&tools)),
        2 => SurveyStep::RemoveLast,
        3 => SurveyStep::Finish,
        4 => SurveyStep::Base(dice.one_of(&bases)),
        5 => SurveyStep::RemoveAll,
        _ => SurveyStep::Leave,
    }
}

/// What holds at every moment.
fn check(state: &State) {
    for line in &state.log {
        assert!(!line.text.contains('\n'), "{line:?}");
    }
    assert!(!state.may_quit);
    let Some(open) = &state.open else {
        return;
    };
    let parts = open.flight().parts();
    let count = parts.photos.len();
    assert_eq!(open.review.outcomes().len(), count);
    assert_eq!(open.review.photos().count(), count);
    assert_eq!(open.files.photo_files.len(), count);
    assert_eq!(open.pictures.thumbnails.len(), count);
    assert_eq!(open.pictures.images.len(), count);
    let along = open.review.going_along(Along::Trusted);
    assert_eq!(
        along.iter().filter(|&&along| along).count(),
        open.chosen_count()
    );
    for (photo, along) in open.review.photos().zip(along) {
        let decision = open.history.now().decision(photo.name());
        assert_eq!(photo.decision, decision);
        let is_left_out = decision.is_some_and(|d| d.kind == DecisionKind::LeftOut);
        assert!(!(along && is_left_out));
        assert_eq!(photo.verdict == Verdict::LeftOut, is_left_out);
    }
    assert!(open.review.views().is_none_or(|views| views.len() == count));
    assert!(open.selected.is_none_or(|photo| photo < count));
    let through = open.looking.through;
    assert!(through.is_none_or(|photo| Some(photo) == open.selected || photo < count));
    // The table shows the photos that its filter lets through, each once.
    let text = open.table.order.text.to_lowercase();
    let wanted: BTreeSet<usize> = (0..count)
        .filter(|&photo| {
            let reviewed = open.review.photo(photo).expect("a photo");
            let wanted = open.table.order.verdict;
            let verdict = wanted.is_none_or(|wanted| reviewed.settled() == Some(wanted));
            let doubts = reviewed.doubts.iter().map(ToString::to_string);
            let named = parts.photos[photo].name.clone();
            let mut texts = doubts.chain([named]).map(|text| text.to_lowercase());
            verdict && texts.any(|words| words.contains(&text))
        })
        .collect();
    let shown: BTreeSet<usize> = open.table.shown.iter().copied().collect();
    assert_eq!(shown, wanted);
    assert_eq!(open.table.shown.len(), wanted.len(), "a photo twice");
    if matches!(open.table.order.by, SortBy::Column(column) if column.name == "Top") {
        let tops: Vec<f64> = open
            .table
            .shown
            .iter()
            .filter_map(|&photo| open.scale(photo)?.scale.top)
            .map(|top| {
                if open.table.order.descending {
                    -top
                } else {
                    top
                }
            })
            .collect();
        assert!(tops.is_sorted(), "{tops:?}");
    }
    let orbit = open.looking.orbit;
    assert!(orbit.target.is_finite() && orbit.view().eye.is_finite());
    assert!(orbit.distance > 0.0 && orbit.distance.is_finite());
    assert!((0.0..=1.0).contains(&open.looking.blend));
    if let Measure::Both(a, b) = open.pointer.measure {
        assert!(a.is_finite() && b.is_finite());
    }
}

/// What holds besides once nothing is under way: the numbers are those of the settings.
fn check_at_rest(state: &State) {
    let Some(open) = &state.open else {
        return;
    };
    let (parts, settings) = (open.flight().parts(), open.settings());
    assert!(
        open.computed.gives_the_scales_of(&settings),
        "{:?}",
        open.computed
    );
    let compared = open.objects.compared.iter().map(|(object, _)| object);
    assert!(compared.eq(&settings.scale_objects));
    assert_eq!(parts.unit, settings.unit);
    assert_eq!(parts.ground, settings.ground);
    assert_eq!(parts.image, settings.image);
    assert_eq!(parts.surface.max_edge(), settings.surface.max_edge);
    let log = &state.log[state.log.len().saturating_sub(20)..];
    assert!(open.review.is_looked_at(), "{log:#?}");
    assert_eq!((parts.pair, parts.errors), (settings.pair, settings.errors));
    let tinted = open.tint.as_ref().map(|tint| tint.photo);
    let is_tinted = state.preferences.tint;
    assert!(!is_tinted || tinted == open.selected, "{tinted:?} {log:#?}");
    assert!(open.review.is_looked_at());
    let points = parts.surface.vertices().len();
    // Without a graphics device there is none.
    if let Some(geometry) = &open.geometry {
        assert_eq!(geometry.points, points);
    }
    for (photo, outcome) in open.review.outcomes().iter().enumerate() {
        let trouble = matches!(outcome, Outcome::Trouble(_));
        assert_eq!(trouble, parts.photos[photo].trouble.is_some());
    }
    if let Some(preview) = &open.pictures.preview {
        assert!(preview.photo < open.review.outcomes().len());
    }
}

/// The scales of a flight that is opened with these settings, with nothing done to it.
fn fresh(path: &Path, settings: FlightSettings) -> Vec<Outcome> {
    let options = fragscale::opening::OpenOptions {
        settings: Some(settings),
        ..fragscale::opening::OpenOptions::default()
    };
    let progress = fragscale::jobs::Progress::default();
    let opened = fragscale::opening::open_flight(path, &options, &progress).expect("a flight");
    opened.flight.scales(&progress).expect("scales")
}

/// However the settings got there, the numbers are those of a flight that is opened with them.
fn assert_as_if_opened_anew(open: &OpenFlight) {
    assert_eq!(
        **open.review.outcomes(),
        fresh(&open.files.path, open.settings())
    );
}

#[test]
fn two_thousand_commands_leave_the_window_consistent() {
    let (first, second) = (
        copy("tests/windrow"),
        copy("tests/fixtures/tiltpan-xyz-feet-misses"),
    );
    let sample = copy("assets/sample");
    copy_files("assets/sample/photos", &sample.path().join("photos"));
    let output = tempfile::tempdir().expect("a folder");
    let places = Places {
        flights: [&first, &second, &sample]
            .map(|folder| folder.path().to_owned())
            .to_vec(),
        broken: vec![output.path().join("not there"), flight("Cargo.toml")],
        output: output.path().to_owned(),
    };
    let mut dice = Dice::new(20_170_822);
    let mut desk = Desk::new(Some(first.path()));
    let mut opened_with = 0;
    for step in 0..2000 {
        let app = desk.harness.state_mut();
        let command = command(&mut dice, app.state(), &places);
        println!("{step}: {command:?}");
        app.apply(command);
        app.poll();
        check(app.state());
        if step % 50 == 0 {
            // The real window: it panics on signs without a glyph and on parts without a name.
            desk.harness.run_ok();
            check(desk.harness.state().state());
        }
        if step % 200 == 199 {
            desk.settle();
            check_at_rest(desk.harness.state().state());
            if desk.harness.state().state().open.is_some() {
                assert_as_if_opened_anew(desk.open());
                opened_with += 1;
            }
        }
    }
    assert!(opened_with > 3, "mostly there is a flight");

    // Everything undone, the settings are those that the flight was opened with.
    let answer_all = |desk: &mut Desk| {
        desk.settle();
        while desk.harness.state().state().held_back.is_some() {
            desk.harness.state_mut().apply(Command::Discard);
            desk.settle();
        }
    };
    answer_all(&mut desk);
    desk.harness
        .state_mut()
        .apply(Command::Open(first.path().to_owned()));
    answer_all(&mut desk);
    let (settings, before) = (
        desk.open().settings(),
        desk.open().review.outcomes().clone(),
    );
    for _ in 0..60 {
        let app = desk.harness.state_mut();
        let now = app.state().open.as_ref().expect("a flight").settings();
        app.apply(Command::Set(self::settings(&mut dice, now)));
        app.poll();
    }
    while desk.open().history.can_undo() {
        desk.harness.state_mut().apply(Command::Undo);
        desk.harness.state_mut().poll();
    }
    desk.settle();
    assert_eq!(desk.open().settings(), settings);
    assert_eq!(*desk.open().review.outcomes(), before);
    check_at_rest(desk.harness.state().state());
}

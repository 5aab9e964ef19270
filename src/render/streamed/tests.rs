//! Tests of the streamed cloud.

use glam::DVec2;

use super::*;
use crate::jobs::Progress;
use crate::surface::{Cloud, Surface};
use crate::surface_buffers::SurfaceBuffers;
use crate::{CloudGeometry, Normals, Orbit, Renderer, Show};

/// A heap of `side` x `side` points on 20 units, red in the west.
fn heap(side: u32) -> Surface {
    let places = (0..side * side).map(|i| {
        // Off the lattice, so that no two rows meet one column of pixels.
        let jitter = f64::from(i.wrapping_mul(2_654_435_761) >> 16) / 65_536.0;
        let x = (f64::from(i % side) + jitter) * 20.0 / f64::from(side) - 10.0;
        let y = (f64::from(i / side) + 1.0 - jitter) * 20.0 / f64::from(side) - 10.0;
        DVec3::new(x, y, 4.0 * (-(x * x + y * y) / 30.0).exp())
    });
    let points: Vec<DVec3> = places.collect();
    let color = |point: &DVec3| match point.x < 0.0 {
        true => [220, 40, 30],
        false => [40, 160, 60],
    };
    let colors = points.iter().map(color).collect();
    Surface::new(Cloud {
        points,
        colors,
        ..Cloud::default()
    })
    .unwrap()
}

fn levels(surface: &Surface) -> Levels {
    let levels = Levels::new(surface, &Progress::default());
    levels.unwrap().unwrap()
}

fn streaming(gpu: &Gpu, surface: &Surface) -> (Renderer, Orbit) {
    let bounds = surface.bounds();
    let frame = LocalFrame::near(&bounds);
    let mut renderer = Renderer::new(gpu);
    renderer.start(&frame);
    renderer.set_surface(Some(&SurfaceBuffers::streamed(levels(surface), &frame)));
    (renderer, Orbit::new(&bounds))
}

const SHOW_SIZE: [u32; 2] = [160, 120];

/// Of the nodes of a picture of this size at most so much is on the card.
fn looking(in_sight: &dyn Fn(&Extent) -> bool) -> Looking<'_> {
    Looking {
        eye: DVec3::new(0.0, 0.0, 30.0),
        ahead: DVec3::NEG_Z,
        parallel: false,
        // So fine that every point is wanted.
        texel: 1e-9,
        fine: 1.0,
        nearest: 0.1,
        in_sight,
        clip: None,
    }
}

/// The picture of a cloud that is streamed is that of the same cloud uploaded whole: where a file is
/// drawn at once, in the window after some frames, and then nothing more is awaited.
#[test]
fn a_streamed_cloud_is_drawn_as_a_whole_one() {
    let gpu = Gpu::headless().unwrap();
    let surface = heap(300);
    let (mut renderer, mut orbit) = streaming(&gpu, &surface);
    // As near as points are far from each other by more than a texel.
    orbit.distance *= 0.3;
    let view = orbit.view();
    let show = Show::default();
    let mut whole = Renderer::new(&gpu);
    let frame = LocalFrame::near(&surface.bounds());
    whole.start(&frame);
    let (vertices, colors) = (surface.vertices(), surface.colors());
    let cloud = CloudGeometry::new(&frame, vertices, colors, &Normals::default());
    whole.set_cloud(Some(&cloud));
    let as_cloud = Show {
        cloud: true,
        ..Show::default()
    };
    let expected = whole.picture(&view, &as_cloud, SHOW_SIZE).unwrap();
    let unlike = |picture: &image::RgbaImage| {
        let pairs = expected.pixels().zip(picture.pixels());
        let far = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
            a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 40)
        };
        pairs.filter(far).count()
    };
    // The mesh is on, and there is none: the points stand for it.
    let picture = renderer.picture(&view, &show, SHOW_SIZE).unwrap();
    // Points have about the same size; some edges differ.
    assert!(unlike(&picture) < 300, "{}", unlike(&picture));

    let (mut window, _) = streaming(&gpu, &surface);
    let first = window.draw_portion(&view, &show, SHOW_SIZE, usize::MAX);
    assert!(first.awaited && first.points == 0);
    let mut calls = 0;
    let last = loop {
        let drawn = window.draw_portion(&view, &show, SHOW_SIZE, usize::MAX);
        if !drawn.awaited {
            break drawn;
        }
        calls += 1;
        assert!(calls < 10_000);
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    assert!(last.whole && last.points > 10_000, "{last:?}");
    let again = window.draw_portion(&view, &show, SHOW_SIZE, usize::MAX);
    assert_eq!(again.points, last.points);
    let targets = window.picture(&view, &show, SHOW_SIZE).unwrap();
    assert!(targets == picture);
    assert_eq!(gpu.take_error(), None);
}

/// While the view moves fewer points are drawn, and none of them is loaded for nothing.
#[test]
fn fewer_points_are_drawn_on_demand() {
    let gpu = Gpu::headless().unwrap();
    let (mut renderer, mut orbit) = streaming(&gpu, &heap(400));
    orbit.distance *= 0.2;
    let show = |max_points| Show {
        max_points,
        ..Show::default()
    };
    let view = orbit.view();
    let wait = |renderer: &mut Renderer, show: &Show| loop {
        let drawn = renderer.draw_portion(&view, show, SHOW_SIZE, usize::MAX);
        if !drawn.awaited {
            break drawn.points;
        }
        std::thread::yield_now();
    };
    let few = wait(&mut renderer, &show(Some(20_000)));
    let all = wait(&mut renderer, &show(None));
    assert!(
        few > 5000 && few <= 20_000 && all > 2 * few,
        "{few} of {all}"
    );
    // What was there for all is there for few.
    assert_eq!(wait(&mut renderer, &show(Some(20_000))), few);
    orbit.orbit(DVec2::new(40.0, 0.0));
    assert_eq!(gpu.take_error(), None);
}

/// All points arrive, each node once; a coarse picture has larger points; what was wanted least lately
/// leaves the card, and the picture at hand never does.
#[test]
fn nodes_come_and_go() {
    let gpu = Gpu::headless().unwrap();
    let surface = heap(400);
    let frame = LocalFrame::near(&surface.bounds());
    let source = StreamSource::new(levels(&surface), &frame);
    let nodes = source.levels.nodes().len();
    let mut streamed = Streamed::new(&gpu, &source);
    let everywhere = |_: &Extent| true;
    let first = streamed.present(&looking(&everywhere), 20_000, Most::All);
    assert!(!first.awaited && first.least > 0.0);
    let all = streamed.present(&looking(&everywhere), usize::MAX, Most::All);
    assert_eq!(
        (all.tiles.len(), all.awaited, all.least),
        (nodes, false, 0.0)
    );
    assert!(all.key != first.key);
    let bytes = streamed.bytes;
    assert_eq!(bytes, 160_000 * 20);
    let of_the_west = |extent: &Extent| extent.min.x < -1.0;
    let west = streamed.present(&looking(&of_the_west), usize::MAX, Most::All);
    assert!(west.tiles.len() < nodes);
    // Still there.
    assert_eq!(streamed.bytes, bytes);
    // What is cut away is not brought either, however the box is turned.
    let clip = LevelBox {
        turn: 0.7,
        ..LevelBox::of(&Bounds {
            min: DVec3::new(-9.0, -9.0, 0.0),
            max: DVec3::new(-8.0, -8.0, 4.0),
        })
    };
    let clipped = Looking {
        clip: Some(clip),
        ..looking(&everywhere)
    };
    let corner = streamed.present(&clipped, usize::MAX, Most::All);
    assert!(!corner.tiles.is_empty() && corner.tiles.len() < west.tiles.len());
    streamed.memory = bytes / 10;
    let west_again = streamed.present(&looking(&of_the_west), usize::MAX, Most::All);
    assert_eq!(west_again.key, west.key);
    let kept: u64 = west.tiles.iter().map(Tile::bytes).sum();
    assert_eq!(streamed.bytes, kept);
    assert_eq!(streamed.residents.len(), west.tiles.len());
}

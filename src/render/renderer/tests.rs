//! Tests of the renderer.

use super::*;
use crate::{Normals, Orbit};

/// A heap of 20 units with a grid under it, which reach over every seam; `cells` along an edge.
fn heap(gpu: &Gpu, cells: u32) -> (Renderer, Orbit) {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..=cells {
        for column in 0..=cells {
            let [x, y] = [column, row].map(|i| f64::from(i) * 20.0 / f64::from(cells) - 10.0);
            vertices.push(DVec3::new(x, y, 4.0 * (-(x * x + y * y) / 30.0).exp()));
            if row < cells && column < cells {
                let at = row * (cells + 1) + column;
                triangles.push([at, at + 1, at + cells + 2]);
                triangles.push([at, at + cells + 2, at + cells + 1]);
            }
        }
    }
    let bounds = Bounds::of(&vertices).unwrap();
    let frame = LocalFrame::near(&bounds);
    let normals = Normals::of(&frame, vertices.iter().copied(), &triangles);
    let points = vertices.iter().copied();
    let mesh = MeshGeometry::new(&frame, points, &[], &normals, &triangles);
    let mut renderer = Renderer::new(gpu);
    renderer.start(&frame);
    renderer.set_mesh(Some(&mesh));
    (renderer, Orbit::new(&bounds))
}

/// A picture put together from parts has no seams: it is the one drawn at once.
#[test]
fn parts_make_the_whole() {
    let gpu = Gpu::headless().unwrap();
    let (mut renderer, mut orbit) = heap(&gpu, 40);
    let show = Show {
        ground: Some(0.0),
        wireframe: true,
        ..Show::default()
    };
    for orthographic in [false, true] {
        orbit.orthographic = orthographic;
        let view = orbit.view();
        let whole = renderer.picture(&view, &show, [301, 203]).unwrap();
        let parts = renderer
            .picture_in_parts(&view, &show, [301, 203], 100)
            .unwrap();
        let differ = whole
            .pixels()
            .zip(parts.pixels())
            .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 24));
        // A thin line's edge may be rounded to another texel.
        assert!(differ.count() < 30);
    }
    assert_eq!(gpu.take_error(), None);
}

/// The window's frame and a file's picture come from the same call: with one sample a pixel they
/// show the same.
#[test]
fn a_frame_in_the_window_is_read_back_as_drawn() {
    let gpu = Gpu::headless().unwrap();
    let (mut renderer, orbit) = heap(&gpu, 40);
    let show = Show::default();
    renderer.draw(&orbit.view(), &show, [120, 80]);
    let frame = read_back(&gpu, &renderer.targets.as_ref().unwrap().picture).unwrap();
    let picture = renderer.picture(&orbit.view(), &show, [120, 80]).unwrap();
    let pairs = frame.pixels().zip(picture.pixels());
    let unlike = pairs.filter(|(a, b)| {
        a.0[..3]
            .iter()
            .zip(&b.0[..3])
            .any(|(a, b)| a.abs_diff(*b) > 60)
    });
    // Only edges differ, by their smoothness.
    assert!(unlike.count() < 400);
    // The heap is in the middle, the background in the corner.
    assert_eq!(frame.get_pixel(119, 0).0, [24, 26, 30, 255]);
    assert!(frame.get_pixel(60, 45)[0] > 90);
}

/// A large surface drawn in portions ends as the one drawn at once; until then the picture before
/// it stands in.
#[test]
fn portions_make_the_whole() {
    let gpu = Gpu::headless().unwrap();
    let size = [160, 120];
    let frame =
        |renderer: &Renderer| read_back(&gpu, &renderer.targets.as_ref().unwrap().picture).unwrap();
    let (mut at_once, orbit) = heap(&gpu, 400);
    let view = orbit.view();
    let slope = Show {
        color_by: ColorBy::Slope,
        ..Show::default()
    };
    assert!(at_once.draw(&view, &slope, size).whole);
    let expected = frame(&at_once);

    let (mut renderer, _) = heap(&gpu, 400);
    renderer.draw(&view, &Show::default(), size);
    let before = frame(&renderer);
    assert!(before != expected);
    let mut calls = 1;
    while !renderer.draw_portion(&view, &slope, size, 1).whole {
        assert!(frame(&renderer) == before);
        calls += 1;
    }
    // 320 000 triangles in tiles of at most 65 536.
    assert!(calls >= 5, "{calls}");
    assert!(frame(&renderer) == expected);
    // From elsewhere nothing can stand in.
    let mut other = orbit;
    other.orbit(glam::DVec2::new(100.0, 0.0));
    assert!(renderer.draw_portion(&other.view(), &slope, size, 1).whole);
    assert_eq!(gpu.take_error(), None);
}

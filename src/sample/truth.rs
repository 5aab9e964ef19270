//! What is true of a simulated flight: corner points and scales of the noise-free geometry, met by
//! the lab's own rays (not by `surface` and `scale`, which are to be tested against them), and the
//! sizes of all fragments.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::flight_plan::Shot;
use super::scene::{Scene, SceneCaster, Thing};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::geometry::Ray;

/// Density of the rock, kg/m3: granite.
pub(super) const DENSITY: f64 = 2700.0;

/// The truth of a flight, as the JSON of truth.json. `origin` is added to every point.
///
/// # Errors
/// Where the scene cannot be met.
pub(super) fn truth(
    scene: &Scene,
    camera: &Camera,
    shots: &[Shot],
    origin: DVec3,
) -> Result<Value, Fault> {
    let mut caster = scene.caster()?;
    let photos: Vec<Value> = shots
        .iter()
        .map(|shot| {
            let pose = |(center, [tilt, pan]): (DVec3, [f64; 2])| {
                json!({"center": (center + origin).to_array(), "tilt": tilt, "pan": pan})
            };
            json!({
                "photo": shot.name,
                "planned": pose(shot.planned),
                "actual": pose(shot.actual),
                "undistorted": image(&mut caster, camera, shot, origin, false),
                "as_shot": image(&mut caster, camera, shot, origin, true),
            })
        })
        .collect();
    let pile = scene.pile();
    let fragments: Vec<Value> = pile
        .fragments
        .iter()
        .map(|fragment| {
            let volume = pile.volume(fragment);
            // Five digits: a ten-thousandth of a fragment.
            let digits = |x: f64| format!("{x:.4e}").parse::<f64>().unwrap_or(x);
            json!([digits(fragment.size), digits(volume)])
        })
        .collect();
    let spheres: Vec<Value> = scene
        .spheres()
        .iter()
        .map(|sphere| {
            json!({"center": (sphere.center + origin).to_array(), "diameter": sphere.radius * 2.0})
        })
        .collect();
    Ok(json!({
        "unit": "m",
        "photos": photos,
        "spheres": spheres,
        "density_kg_per_m3": DENSITY,
        "fragment_columns": ["sieve_size_m", "volume_m3"],
        "fragments": fragments,
    }))
}

/// Corners and edge scales (pixels per metre) of one image.
fn image(
    caster: &mut SceneCaster<'_>,
    camera: &Camera,
    shot: &Shot,
    origin: DVec3,
    as_shot: bool,
) -> Value {
    let pose = shot.pose();
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(u, v)| {
        let pixel = DVec2::new(u, v);
        let in_camera = if as_shot {
            camera.direction_as_shot(pixel).ok()
        } else {
            Some(camera.direction_undistorted(pixel))
        };
        let direction = (pose.rotation * in_camera?).normalize();
        let ray = Ray {
            origin: pose.center,
            direction,
        };
        caster
            .cast_at_surface(&ray)
            .map(|met| (direction * met.t, met))
    });
    let scale = |pixels: f64, a: usize, b: usize| {
        let (a, b) = (corners[a].as_ref()?, corners[b].as_ref()?);
        Some(pixels / (a.0 - b.0).length())
    };
    let points = corners.iter().map(|corner| {
        corner.as_ref().map(|(_, met)| {
            let on = match met.thing {
                Thing::Ground => json!("ground"),
                Thing::Fragment(index) => json!(index + 1),
                // Not met at the surface.
                Thing::Sphere(_) => Value::Null,
            };
            json!({"point": (met.point + origin).to_array(), "on": on})
        })
    });
    json!({
        "corners": points.collect::<Vec<_>>(),
        "scale": {
            "top": scale(w, 0, 1), "right": scale(h, 1, 2),
            "bottom": scale(w, 3, 2), "left": scale(h, 0, 3),
        },
    })
}

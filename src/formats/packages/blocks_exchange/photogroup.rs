//! The camera of a Photogroup.

use glam::{DMat3, DVec3};
use roxmltree::Node;

use crate::camera::{Brown, Camera, Distortion};
use crate::cameras::polynomial_fisheye;
use crate::fault::Fault;
use crate::text::fields::shown;

use super::{child, fault, number, optional, text_of};

/// The camera, or, in words, why its photos cannot be used.
pub(super) fn camera(
    group: Node<'_, '_>,
    warnings: &mut Vec<String>,
) -> Result<Result<Camera, String>, Fault> {
    let Some(dimensions) = child(group, "ImageDimensions") else {
        return Ok(Err("the image's dimensions are not said".to_owned()));
    };
    let side = |name| -> Result<u32, Fault> {
        let text = text_of(dimensions, name).unwrap_or_default();
        let side = text.parse().ok().filter(|side| *side > 0);
        side.ok_or_else(|| {
            fault(
                dimensions,
                format!("{name} is '{}', no size in pixels", shown(text)),
            )
        })
    };
    let (width, height) = (side("Width")?, side("Height")?);
    let mut camera = Camera {
        name: text_of(group, "Name").unwrap_or_default().to_owned(),
        width,
        height,
        fx: 0.0,
        fy: 0.0,
        cx: f64::from(width) / 2.0,
        cy: f64::from(height) / 2.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let longer = f64::from(width.max(height));
    let pixel_size = match (
        optional(group, "PixelSize")?,
        optional(group, "SensorSize")?,
    ) {
        (Some(size), _) => Some(size),
        (None, Some(sensor)) => Some(sensor / longer),
        (None, None) => None,
    };
    if let Some(point) = child(group, "PrincipalPoint") {
        let offset = (optional(point, "xmm")?, optional(point, "ymm")?);
        if let (Some(x), Some(y)) = offset {
            let Some(pixel_size) = pixel_size else {
                return Ok(Err("the size of a pixel is not said".to_owned()));
            };
            let offset = axes(group)? * DVec3::new(x, y, 0.0) / pixel_size;
            camera.cx += offset.x;
            camera.cy += offset.y;
        } else {
            camera.cx = number(point, "x")? + 0.5;
            camera.cy = number(point, "y")? + 0.5;
        }
    }
    match text_of(group, "CameraModelType").unwrap_or("Perspective") {
        "Perspective" => {}
        "Fisheye" => return fisheye(group, camera, warnings),
        other => {
            return Ok(Err(format!(
                "their camera model '{}' is not known",
                shown(other)
            )));
        }
    }
    let pixels = optional(group, "FocalLengthPixels")?;
    let film = (optional(group, "FocalLength")?, pixel_size);
    camera.fx = match (pixels, film) {
        (Some(pixels), _) => pixels,
        (None, (Some(focal), Some(pixel_size))) => focal / pixel_size,
        (None, _) => return Ok(Err("the focal length is not said".to_owned())),
    };
    let aspect = optional(group, "AspectRatio")?.unwrap_or(1.0);
    camera.fy = camera.fx * aspect;
    camera.skew = optional(group, "Skew")?.unwrap_or(0.0);
    if aspect != 1.0 || camera.skew != 0.0 {
        warnings.push(format!(
            "'{}': AspectRatio {aspect} is taken as fy / fx, Skew {} as pixels",
            shown(&camera.name),
            camera.skew
        ));
    }
    if let Some(lens) = child(group, "Distortion") {
        let part = |name| Ok::<f64, Fault>(optional(lens, name)?.unwrap_or(0.0));
        let [k1, k2, k3] = [part("K1")?, part("K2")?, part("K3")?];
        let [p1, p2] = [part("P1")?, part("P2")?];
        if [k1, k2, k3, p1, p2] != [0.0; 5] {
            let opencv = [k1, k2, p2, p1, k3, 0.0, 0.0, 0.0];
            camera.distortion = Distortion::Brown(Brown::new(opencv));
        }
        let turned = text_of(group, "CameraOrientation").is_some_and(|axes| axes != "XRightYDown");
        if turned && [p1, p2] != [0.0; 2] {
            warnings.push(format!(
                "'{}': P1 and P2 are taken along the image's right and down, though its camera \
                 axes are others",
                shown(&camera.name)
            ));
        }
    }
    camera
        .validate()
        .map_err(|error| fault(group, error.to_string()))?;
    Ok(Ok(camera))
}

fn fisheye(
    group: Node<'_, '_>,
    camera: Camera,
    warnings: &mut Vec<String>,
) -> Result<Result<Camera, String>, Fault> {
    let Some(matrix) = child(group, "FisheyeFocalMatrix") else {
        return Ok(Err("the fish-eye's focal matrix is not said".to_owned()));
    };
    let affine = [
        number(matrix, "M_00")?,
        number(matrix, "M_01")?,
        number(matrix, "M_10")?,
        number(matrix, "M_11")?,
    ];
    let mut polynomial = [0.0, 1.0, 0.0, 0.0, 0.0];
    if let Some(lens) = child(group, "FisheyeDistortion") {
        for (name, coefficient) in ["P0", "P1", "P2", "P3", "P4"]
            .into_iter()
            .zip(&mut polynomial)
        {
            *coefficient = optional(lens, name)?.unwrap_or(*coefficient);
        }
    }
    let lens = polynomial_fisheye::with_lens(camera, affine, &polynomial);
    Ok(lens.map(|(camera, off)| {
        if let Some(off) = off {
            let name = shown(&camera.name);
            warnings.push(format!("'{name}': its fish-eye is fitted, to {off:.3} px"));
        }
        camera
    }))
}

/// Where the camera axes of the Photogroup's rotations lie among right, down and forward: its
/// columns.
pub(super) fn axes(group: Node<'_, '_>) -> Result<DMat3, Fault> {
    let name = text_of(group, "CameraOrientation").unwrap_or("XRightYDown");
    let side = |side| match side {
        "Right" => Some(DVec3::X),
        "Left" => Some(DVec3::NEG_X),
        "Down" => Some(DVec3::Y),
        "Up" => Some(DVec3::NEG_Y),
        _ => None,
    };
    let found = name.strip_prefix('X').and_then(|rest| {
        let (x, y) = rest.split_once('Y')?;
        let (x, y) = (side(x)?, side(y)?);
        (x.dot(y) == 0.0).then(|| DMat3::from_cols(x, y, x.cross(y)))
    });
    found.ok_or_else(|| {
        let what = format!("the CameraOrientation '{}' is not known", shown(name));
        fault(group, what)
    })
}

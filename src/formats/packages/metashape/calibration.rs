//! A `<calibration>`: in a `<sensor>` of cameras.xml, or the root of a calibration file (Tools >
//! Camera Calibration > Save).
//!
//! From the Metashape manual, appendix "Camera models", and Agisoft's forum (topic 6437). The image
//! spans (0, 0) to (w, h); the middle of the top-left pixel is (0.5, 0.5).
//!
//! ```text
//! u = w/2 + cx + x' (f + b1) + y' b2          v = h/2 + cy + y' f
//! ```
//!
//! so fx = f + b1, fy = f, skew = b2. (x', y') is what `camera::Agisoft` documents: **p1 and p2 are
//! swapped** against OpenCV. Elements that are left out are 0. The projection (`type` of the element
//! in cameras.xml, `<projection>` in a file) is frame, fisheye (since 2.3 equidistant_fisheye) or
//! equisolid_fisheye, which is taken at its definition, 2 f sin(theta/2).
//!
//! PhotoScan up to 1.2 wrote fx, fy, skew instead of f, b1, b2, and cx, cy from the top-left corner
//! ("f = fy, b1 = fx - fy, b2 = skew", Agisoft's support). Its manual, and that of Agisoft Lens, have
//! p1 and p2 in OpenCV's order, so they are not swapped there.
//!
//! Refused: spherical, cylindrical, RPC and other projections. `<covariance>` is read in a sensor (cameras.rs), not in
//! a calibration file.

use roxmltree::Node;

use super::xml::{EXPORT, child, line, number, text};
use crate::camera::{Agisoft, AgisoftProjection, Brown, Camera, Distortion, Fisheye};
use crate::fault::Fault;

/// The elements that are read, or that change nothing.
const KNOWN: [&str; 22] = [
    "projection",
    "width",
    "height",
    "resolution",
    "f",
    "fx",
    "fy",
    "cx",
    "cy",
    "b1",
    "b2",
    "skew",
    "k1",
    "k2",
    "k3",
    "k4",
    "p1",
    "p2",
    "p3",
    "p4",
    "date",
    "covariance",
];

/// A calibration file.
///
/// # Errors
/// Where it is no calibration, or one of a camera that is not modelled.
pub(crate) fn read(text: &str) -> Result<Camera, Fault> {
    let document = super::xml::parse(text)?;
    let root = document.root_element();
    if root.tag_name().name() != "calibration" {
        let name = root.tag_name().name();
        let what = format!("the XML is of '{name}', not of 'calibration'");
        return Err(Fault::new(
            what,
            "save the calibration from Metashape's Tools > Camera Calibration",
        ));
    }
    if let Some(unknown) = unknown(root).first() {
        let what = format!("it has <{unknown}>, which fragscale does not know");
        return Err(Fault::new(
            what,
            "calibrate without additional corrections, or remove it",
        ));
    }
    let projection = child(root, "projection").map_or("frame", super::xml::text);
    camera(root, String::new(), projection, None)
}

/// The elements of a calibration that are not known.
pub(super) fn unknown<'a>(calibration: Node<'a, '_>) -> Vec<&'a str> {
    let elements = calibration.children().filter(Node::is_element);
    elements
        .map(|element| element.tag_name().name())
        .filter(|name| !KNOWN.contains(name))
        .collect()
}

/// The camera of a `<calibration>`. `size` stands in for a calibration without its own.
///
/// # Errors
/// Where a number is missing or impossible, or the projection is none that is modelled.
pub(super) fn camera(
    calibration: Node<'_, '_>,
    name: String,
    projection: &str,
    size: Option<(u32, u32)>,
) -> Result<Camera, Fault> {
    let at = |what: &str| Fault::at(line(calibration), what, EXPORT);
    let projection = match projection {
        "frame" => AgisoftProjection::Frame,
        "fisheye" | "equidistant_fisheye" => AgisoftProjection::EquidistantFisheye,
        "equisolid_fisheye" => AgisoftProjection::EquisolidFisheye,
        other => return Err(unsupported(line(calibration), other)),
    };
    let of = |name| number(calibration, name);
    let or_zero = |name| of(name).map(|number| number.unwrap_or(0.0));
    let (width, height) = size_of(calibration)
        .or(size)
        .ok_or_else(|| at("a calibration has no image size"))?;
    let (w, h) = (f64::from(width), f64::from(height));
    let radial = [
        or_zero("k1")?,
        or_zero("k2")?,
        or_zero("k3")?,
        or_zero("k4")?,
    ];
    let [p1, p2, p3, p4] = [
        or_zero("p1")?,
        or_zero("p2")?,
        or_zero("p3")?,
        or_zero("p4")?,
    ];
    let (fx, fy, cx, cy, skew, p1, p2) = if let Some(f) = of("f")? {
        let (cx, cy) = (w / 2.0 + or_zero("cx")?, h / 2.0 + or_zero("cy")?);
        (f + or_zero("b1")?, f, cx, cy, or_zero("b2")?, p1, p2)
    } else if let Some(fx) = of("fx")? {
        let fy = of("fy")?.unwrap_or(fx);
        let (cx, cy) = (of("cx")?.unwrap_or(w / 2.0), of("cy")?.unwrap_or(h / 2.0));
        (fx, fy, cx, cy, or_zero("skew")?, p2, p1)
    } else {
        return Err(at("a calibration has no focal length <f>"));
    };
    let camera = Camera {
        name,
        width,
        height,
        fx,
        fy,
        cx,
        cy,
        skew,
        distortion: lens(projection, radial, [p1, p2, p3, p4]),
    };
    camera.validate().map_err(|error| at(&error.to_string()))?;
    Ok(camera)
}

/// OpenCV's model where it is the same lens, else Agisoft's.
fn lens(projection: AgisoftProjection, radial: [f64; 4], tangential: [f64; 4]) -> Distortion {
    let ([k1, k2, k3, k4], [p1, p2, p3, p4]) = (radial, tangential);
    let centred = [p1, p2] == [0.0; 2];
    match projection {
        AgisoftProjection::Frame if k4 == 0.0 && (centred || [p3, p4] == [0.0; 2]) => {
            Distortion::Brown(Brown::new([k1, k2, p2, p1, k3, 0.0, 0.0, 0.0]))
        }
        AgisoftProjection::EquidistantFisheye if centred => {
            Distortion::Fisheye(Fisheye::new(radial))
        }
        _ => Distortion::Agisoft(Agisoft::new(projection, radial, tangential)),
    }
}

/// Width and height: attributes of `<resolution>`, or elements.
pub(super) fn size_of(node: Node<'_, '_>) -> Option<(u32, u32)> {
    let side = |name: &'static str| {
        let word = match child(node, "resolution") {
            Some(resolution) => resolution.attribute(name)?,
            None => text(child(node, name)?),
        };
        word.trim().parse::<u32>().ok().filter(|&side| side > 0)
    };
    Some((side("width")?, side("height")?))
}

fn unsupported(line: u64, projection: &str) -> Fault {
    let what = format!("a calibration is of the type '{projection}'");
    match projection {
        "spherical" | "cylindrical" => Fault::at(
            line,
            format!("{what}: a panorama has no corners to measure between"),
            "use photos of a frame camera",
        ),
        _ => Fault::at(
            line,
            format!("{what}, which fragscale does not have"),
            "use photos of a frame or fisheye camera",
        ),
    }
}

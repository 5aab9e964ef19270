//! What outlined photos come to, on one page: the distribution, how it came about, and of each photo its outlines and numbers.

use super::table::PhotoOfSizes;
use crate::delineation::mass::{Step, StepTaken};
use crate::drawing::base64;
use crate::fault::Fault;
use crate::fragmentation::SizeDistribution;
use crate::html_page::{self, Cell, NONE, heading, names, notes, paragraph, table};
use crate::markup::escaped;
use crate::numbers::{counted, significant_digits};
use crate::size_distributions::{FigureContents, FigureStyle, Series, figure_svg, passing_figure};
use crate::units::LengthUnit;

/// The side of the pictures, pixels, and how many a page has: it stays small enough to be sent.
const SIDE: u32 = 900;
const MOST_PICTURES: usize = 60;

/// Of more curves than these only that of all photos is drawn.
const MOST_CURVES: usize = 12;

/// What goes into the page.
#[derive(Debug)]
pub(super) struct FragmentsReport<'a> {
    /// The flight's name.
    pub flight: &'a str,
    /// What outlined the fragments: "learned", "saved and learned".
    pub method: &'a str,
    /// The unit of lengths.
    pub unit: LengthUnit,
    /// How many of it the world's unit is.
    pub factor: f64,
    /// Of each photo, in their order.
    pub photos: Vec<ReportPhoto<'a>>,
    /// Of all photos together, where there is a distribution.
    pub all: Option<ReportSizes<'a>>,
    /// The law of the fines, in words, where one is taken.
    pub tail: Option<&'a str>,
    /// What is to be said of it, a sentence each.
    pub warnings: &'a [String],
}

/// A photo of the page.
#[derive(Debug)]
pub(super) struct ReportPhoto<'a> {
    /// As the flight names it.
    pub photo: &'a str,
    /// The file with its outlines, beside the page.
    pub file: String,
    /// Its bytes, a PNG; empty where they are not to be shown.
    pub picture: Vec<u8>,
    /// How far its edges are spread, pixels.
    pub spread: Option<f64>,
    /// Its distribution, where it has one.
    pub sizes: Option<ReportSizes<'a>>,
}

/// A distribution and how it came about.
#[derive(Debug, Clone, Copy)]
pub(super) struct ReportSizes<'a> {
    /// With its intervals.
    pub sizes: PhotoOfSizes<'a>,
    /// Step by step.
    pub taken: &'a [StepTaken],
}

/// How many pictures the page shows at most.
pub(super) fn report_pictures() -> usize {
    MOST_PICTURES
}

/// The page as HTML.
///
/// # Errors
/// Where a picture is broken.
pub(super) fn fragments_report(report: &FragmentsReport<'_>) -> Result<String, Fault> {
    let unit = report.unit;
    let title = format!("Fragments of {}", report.flight);
    let photos = counted(report.photos.len(), "photo");
    let mut body = vec![paragraph(&format!(
        "{photos}, outlined by: {}. Sizes are sieve openings in {unit}; percentages are of the mass. Intervals are 95 %.",
        report.method
    ))];
    body.push(notes(report.warnings));
    if let Some(all) = &report.all {
        body.push(heading(2, "Size distribution"));
        body.push(html_page::figure(&figure_svg(&report.figure(all))));
        if let Some(tail) = report.tail {
            body.push(paragraph(&format!(
                "Below the smallest size that the photos show, the curve is the word of a law: {tail}."
            )));
        }
        body.push(heading(2, "From fragments to mass"));
        body.push(paragraph(
            "Each step with the share of the mass that it moves to other sizes, and the sizes behind it. A step is left out by \
             --steps.",
        ));
        body.push(report.steps(all));
    }
    body.push(heading(2, "Photos"));
    body.push(paragraph(
        "Whole: fragments that count. Cut: fragments that the photo's edge cuts, or what was left out of it; how large they are nobody knows, and they do not \
         count. Not outlined: the share of the area, in the world. Edges: how far the photo's edges are spread, the full width at half of the maximum. Limit: nothing is claimed \
         below it: an engine outlines no narrower ones, and of what people and other tools outlined it is the smallest that \
         counts. \"May be less\": the lower end of its interval is below the limit. \"May be much more\": too many of the largest fragments are cut by the \
         photo's edge for an upper end.",
    ));
    body.push(report.table());
    body.push(heading(2, "Outlines"));
    body.push(paragraph(
        "Yellow: fragments. Violet: cut ones. Dark: no rock. Look at them before you believe the curve.",
    ));
    for photo in &report.photos {
        body.push(picture(photo)?);
    }
    Ok(html_page::page(&title, &title, &body.concat()))
}

fn picture(photo: &ReportPhoto<'_>) -> Result<String, Fault> {
    let (name, file) = (escaped(photo.photo), escaped(&href(&photo.file)));
    if photo.picture.is_empty() {
        return Ok(format!("<p><a href=\"{file}\">{name}</a></p>\n"));
    }
    let small = crate::picture::decode(&photo.picture)?;
    let small = crate::picture::reduced(&small, SIDE);
    let bytes = crate::picture::encode(&small, crate::picture::PhotoFormat::Jpeg, 80, None, None)?;
    Ok(format!(
        "<figure><figcaption>{name}</figcaption><a href=\"{file}\"><img alt=\"Outlines over {name}\" width=\"{}\" height=\"{}\" \
         style=\"width:100%;height:auto\" src=\"data:image/jpeg;base64,{}\"/></a></figure>\n",
        small.width(),
        small.height(),
        base64(&bytes)
    ))
}

/// A file's name as a link beside the page: what means something in links is written as its bytes.
fn href(file: &str) -> String {
    let mut text = String::new();
    for byte in file.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.' | b'_' | b'-' | b'~' => {
                text.push(char::from(byte))
            }
            _ => text += &format!("%{byte:02X}"),
        }
    }
    text
}

impl FragmentsReport<'_> {
    /// Of each photo a curve, where they are few, and that of all in front.
    fn figure(&self, all: &ReportSizes<'_>) -> FigureContents {
        let of = |number: usize, sizes: &PhotoOfSizes<'_>| Series {
            name: sizes.photo.to_owned(),
            style: FigureStyle::of(number),
            points: Vec::new(),
            line: self.in_unit(&sizes.by_mass.curve),
            marks: Vec::new(),
        };
        let photos: Vec<&ReportSizes<'_>> = self
            .photos
            .iter()
            .filter_map(|photo| photo.sizes.as_ref())
            .collect();
        let mut series = Vec::new();
        if photos.len() > 1 && photos.len() <= MOST_CURVES {
            series.extend(
                (1..)
                    .zip(&photos)
                    .map(|(number, photo)| of(number, &photo.sizes)),
            );
        }
        let mut of_all = of(0, &all.sizes);
        of_all.points.clone_from(&of_all.line);
        series.push(of_all);
        passing_figure(self.unit, series)
    }

    fn in_unit(&self, curve: &SizeDistribution) -> Vec<[f64; 2]> {
        let points = curve.points().iter();
        points
            .map(|[size, percent]| [size * self.factor, *percent])
            .collect()
    }

    fn steps(&self, all: &ReportSizes<'_>) -> String {
        let head = names(&["Step", "Share of the mass, %", "P20", "P50", "P80"]);
        let row = |name: &str, share: String, curve: &SizeDistribution| {
            let size = |percent: f64| {
                let size = curve.size_at(percent);
                size.map_or_else(
                    || NONE.to_owned(),
                    |size| significant_digits(size * self.factor, 3),
                )
            };
            let [p20, p50, p80] = [20.0, 50.0, 80.0].map(size);
            vec![
                Cell::from(name),
                share.into(),
                p20.into(),
                p50.into(),
                p80.into(),
            ]
        };
        let mut rows: Vec<Vec<Cell>> = all
            .taken
            .iter()
            .map(|of| {
                let name = match of.step {
                    Step::Seen => "Fragments by the area that is seen (Delesse)",
                    Step::Edges => "edges: large ones are cut more often (Miles, Lantuejoul)",
                    Step::Engine => "engine: its sizes are too large on simulated piles",
                    Step::Pores => "pores: small ones are seen deeper down between large ones",
                    Step::Fines => "fines: what is not outlined",
                };
                row(name, format!("{:.1}", 100.0 * of.share), &of.curve)
            })
            .collect();
        if let Some(law) = self.tail {
            let name = format!("tail: how the fines are distributed ({law})");
            let curve = &all.sizes.by_mass.curve;
            rows.push(row(
                &name,
                format!("{:.1}", 100.0 * all.sizes.by_mass.fines),
                curve,
            ));
        }
        table(&head, rows)
    }

    fn table(&self) -> String {
        let unit = self.unit.symbol();
        let heads = [
            "Photo".to_owned(),
            "Whole".to_owned(),
            "Cut".to_owned(),
            "Not outlined, %".to_owned(),
            "Edges, px".to_owned(),
            format!("Edges, {unit}"),
            format!("Limit, {unit}"),
            format!("P20, {unit}"),
            format!("P50, {unit}"),
            format!("P80, {unit}"),
        ];
        let none = || Cell::from(NONE);
        let cells = |name: &str, spread: Option<f64>, sizes: Option<&PhotoOfSizes<'_>>| {
            let width = spread.map(crate::picture::full_width);
            let mut row = vec![Cell::from(name)];
            let Some(sizes) = sizes else {
                row.extend((1..heads.len()).map(|_| none()));
                return row;
            };
            let by_mass = sizes.by_mass;
            row.push(by_mass.whole.to_string().into());
            row.push(by_mass.cut.to_string().into());
            row.push(format!("{:.1}", 100.0 * by_mass.unfound).into());
            row.push(width.map_or_else(none, |width| format!("{width:.1}").into()));
            let across = width
                .zip(sizes.scale)
                .map(|(width, scale)| width / scale * self.factor);
            row.push(across.map_or_else(none, |across| {
                let text = if across > 0.0 {
                    significant_digits(across, 2)
                } else {
                    "0".to_owned()
                };
                text.into()
            }));
            row.push(significant_digits(by_mass.limit * self.factor, 2).into());
            for interval in sizes.intervals {
                let text = sizes.size_in_words(interval.percent, self.factor, "");
                row.push(text.map_or_else(none, Cell::from));
            }
            row
        };
        let photos = self.photos.iter().map(|photo| {
            cells(
                photo.photo,
                photo.spread,
                photo.sizes.as_ref().map(|of| &of.sizes),
            )
        });
        let mut rows: Vec<Vec<Cell>> = photos.collect();
        if self.photos.len() > 1 {
            rows.extend(
                self.all
                    .as_ref()
                    .map(|all| cells(all.sizes.photo, None, Some(&all.sizes))),
            );
        }
        table(&heads, rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delineation::intervals::SizeInterval;
    use crate::delineation::mass::ByMass;

    fn by_mass() -> ByMass {
        ByMass {
            curve: SizeDistribution::new(vec![[0.01, 20.0], [0.1, 80.0], [0.2, 100.0]]).unwrap(),
            whole: 321,
            cut: 17,
            unfound: 0.3,
            fines: 0.2,
            limit: 0.01,
            area: 4.0,
        }
    }

    /// Every number that the page is made of stands in it, in the unit that was asked for, and names cannot break it.
    #[test]
    fn says_what_it_is_given() {
        let by_mass = by_mass();
        let intervals = [
            SizeInterval {
                percent: 20.0,
                low: None,
                high: None,
            },
            SizeInterval {
                percent: 50.0,
                low: Some(0.03),
                high: Some(0.034),
            },
            SizeInterval {
                percent: 80.0,
                low: Some(0.09),
                high: Some(0.11),
            },
        ];
        let taken = [
            StepTaken {
                step: Step::Seen,
                share: 1.0,
                curve: by_mass.curve.clone(),
            },
            StepTaken {
                step: Step::Pores,
                share: 0.057,
                curve: by_mass.curve.clone(),
            },
        ];
        let sizes = |photo| ReportSizes {
            sizes: PhotoOfSizes {
                photo,
                by_mass: &by_mass,
                intervals: &intervals,
                scale: Some(500.0),
            },
            taken: &taken,
        };
        let picture = image::RgbImage::from_pixel(40, 20, image::Rgb([9, 99, 9]));
        let picture =
            crate::picture::encode(&picture, crate::picture::PhotoFormat::Png, 100, None, None)
                .unwrap();
        let report = FragmentsReport {
            flight: "A & B",
            method: "learned",
            unit: LengthUnit::Centimetre,
            factor: 100.0,
            photos: vec![
                ReportPhoto {
                    photo: "a<b>.jpg",
                    file: "a b#_outlines.png".to_owned(),
                    picture,
                    // 2.355 times as wide: 4.7 px, at 500 px a metre 0.94 cm.
                    spread: Some(2.0),
                    sizes: Some(sizes("a<b>.jpg")),
                },
                ReportPhoto {
                    photo: "c.jpg",
                    file: "c_outlines.png".to_owned(),
                    picture: Vec::new(),
                    spread: None,
                    sizes: None,
                },
            ],
            all: Some(sizes("all photos")),
            tail: Some("Swebrec"),
            warnings: &["c.jpg: no size distribution".to_owned()],
        };
        let html = fragments_report(&report).unwrap();
        for wanted in [
            "Fragments of A &amp; B",
            "a&lt;b&gt;.jpg",
            "href=\"a%20b%23_outlines.png\"",
            "href=\"c_outlines.png\"",
            "data:image/jpeg;base64,",
            "<td>321</td>",
            "<td>4.7</td><td>0.94</td><td>1.0</td>",
            "<td>5.7</td>",
            "tail: how the fines are distributed (Swebrec)",
            "c.jpg: no size distribution",
            "all photos",
        ] {
            assert!(html.contains(wanted), "{wanted} in {html}");
        }
        assert!(!html.contains("a<b>"));
    }
}

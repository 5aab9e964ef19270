//! Outlines in the forms of other tools, beside the label images: `--also`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use crate::cli::outputs::Outputs;
use crate::delineation::LabelImage;
use crate::exports::{self, CocoFile, CvatFile, OUTLINE_ENDINGS};
use crate::fault::Fault;
use crate::files::{Kind, last_segment};

/// A form that other tools read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum OtherForm {
    /// fragments_coco.json, of all photos.
    Coco,
    /// NAME_labelme.json.
    Labelme,
    /// fragments_cvat.xml, of all photos: CVAT for images 1.1.
    Cvat,
    /// NAME_fragments.geojson, in pixels.
    Geojson,
    /// NAME_labels.tif, 32 bits.
    Tiff,
}

/// What is written for other tools.
pub(super) struct WrittenOutlines<'a> {
    to: &'a Path,
    forms: &'a [OtherForm],
    coco: CocoFile,
    cvat: CvatFile,
}

impl<'a> WrittenOutlines<'a> {
    /// Of no photo yet.
    pub(super) fn new(to: &'a Path, forms: &'a [OtherForm]) -> Self {
        Self {
            to,
            forms,
            coco: CocoFile::default(),
            cvat: CvatFile::default(),
        }
    }

    /// The files that will be written of photos with these stems.
    pub(super) fn paths<'s>(&self, stems: impl Iterator<Item = &'s str>) -> Vec<PathBuf> {
        let stems: Vec<&str> = stems.collect();
        let mut paths = Vec::new();
        for form in self.forms {
            match of_all(*form) {
                Some(name) => paths.push(self.to.join(name)),
                None => paths.extend(stems.iter().map(|stem| self.path(*form, stem))),
            }
        }
        paths
    }

    /// Whether files of all photos need the labels of each.
    pub(super) fn needs_labels(&self) -> bool {
        self.forms.iter().any(|form| of_all(*form).is_some())
    }

    /// The files of a photo alone.
    pub(super) fn of_photo(&self, stem: &str) -> Vec<PathBuf> {
        let forms = self.forms.iter().filter(|form| of_all(**form).is_none());
        forms.map(|form| self.path(*form, stem)).collect()
    }

    fn path(&self, form: OtherForm, stem: &str) -> PathBuf {
        self.to.join(format!("{stem}{}", ending(form)))
    }

    /// The files of a photo alone; it is kept for those of all.
    ///
    /// # Errors
    /// Where a file would be too large.
    pub(super) fn add(
        &mut self,
        photo: &str,
        stem: &str,
        labels: &LabelImage,
    ) -> Result<Vec<(PathBuf, Vec<u8>)>, Fault> {
        let mut files = Vec::new();
        for form in self.forms {
            let bytes = match form {
                OtherForm::Coco => {
                    self.coco.add(photo, labels);
                    continue;
                }
                OtherForm::Cvat => {
                    self.cvat.add(photo, labels);
                    continue;
                }
                OtherForm::Labelme => {
                    exports::labelme_json(last_segment(photo), labels).into_bytes()
                }
                OtherForm::Geojson => exports::fragments_geojson(photo, labels).into_bytes(),
                OtherForm::Tiff => exports::labels_tiff(labels)?,
            };
            files.push((self.path(*form, stem), bytes));
        }
        Ok(files)
    }

    /// Writes the files of all photos.
    ///
    /// # Errors
    /// Where one cannot be written.
    pub(super) fn finish(&self, outputs: &Outputs<'_>) -> Result<(), String> {
        for form in self.forms {
            let Some(name) = of_all(*form) else {
                continue;
            };
            let text = match form {
                OtherForm::Cvat => self.cvat.text(),
                _ => self.coco.text().map_err(|error| error.to_string())?,
            };
            outputs.write(&self.to.join(name), text.as_bytes(), Kind::Result)?;
        }
        Ok(())
    }
}

/// How its files end.
fn ending(form: OtherForm) -> &'static str {
    let [coco, cvat, labelme, geojson, tiff] = OUTLINE_ENDINGS;
    match form {
        OtherForm::Coco => coco,
        OtherForm::Cvat => cvat,
        OtherForm::Labelme => labelme,
        OtherForm::Geojson => geojson,
        OtherForm::Tiff => tiff,
    }
}

/// The file of all photos, of a form that has one.
fn of_all(form: OtherForm) -> Option<&'static str> {
    match form {
        OtherForm::Coco | OtherForm::Cvat => Some(ending(form)),
        OtherForm::Labelme | OtherForm::Geojson | OtherForm::Tiff => None,
    }
}

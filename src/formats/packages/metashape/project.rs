//! Projects: `NAME.psx` with its folder, and the older `NAME.psz` in one file.
//!
//! ```text
//! NAME.psx                        <document path="{projectname}.files/project.zip"/>
//! NAME.files/project.zip          doc.xml: <chunks active_id=""> <chunk id="" path="0/chunk.zip"/>
//! NAME.files/0/chunk.zip          doc.xml: <chunk> as in cameras.xml, <frames> <frame path="0/frame.zip"/>
//! NAME.files/0/0/frame.zip        doc.xml: <frame> <cameras> <camera camera_id=""> <photo path=""/>
//! NAME.psz                        doc.xml: all of it in one <document>
//! ```
//!
//! Each path is relative to the folder of the file that names it; those of photos are so to the
//! frame.zip, or to the .psz. Of several frames (moments of a moving scene) the first is read. Zip
//! files are inflated up to a limit, so a zip bomb is refused.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Component, Path, PathBuf};

use roxmltree::Node;
use zip::ZipArchive;

use super::points::TiePoints;
use super::xml::{child, children, parse};
use super::{ALIGN, has_aligned, one_of_chunks, paths_of, read_chunk, read_xml};
use crate::fault::Fault;
use crate::files::{FileError, open_file, read_text, text_from_bytes};
use crate::packages::reconstruction::Project;

/// How large a document may be, inflated, in bytes: a frame of 100 000 photos with their metadata
/// has 200 MB.
const LARGEST: u64 = 1 << 29;

/// What to do about a project that is not whole.
const COPY: &str = "copy the .psx together with its .files folder, or export the cameras as XML";

/// Reads a cameras.xml, a .psx or a .psz.
///
/// # Errors
/// With the file and the place in it.
pub(crate) fn read_project(path: &Path) -> Result<Project, FileError> {
    let mut start = Vec::new();
    let read = open_file(path)?.take(4).read_to_end(&mut start);
    read.map_err(|e| unreadable(path, &e.to_string()))?;
    if start.starts_with(b"PK") {
        return read_psz(path);
    }
    let text = read_text(path)?;
    let at = |fault| FileError::new(path, fault);
    let document = parse(&text).map_err(at)?;
    match document.root_element().attribute("path") {
        Some(named) => read_psx(path, named),
        None => read_xml(&text).map(Project::from).map_err(at),
    }
}

fn read_psz(path: &Path) -> Result<Project, FileError> {
    let text = read_document(path)?;
    let at = |fault| FileError::new(path, fault);
    let reconstruction = read_xml(&text).map_err(at)?;
    let document = parse(&text).map_err(at)?;
    let photos = document
        .descendants()
        .filter(|node| node.has_tag_name("photo"));
    Ok(Project {
        photos: folder_of(path, photos.filter_map(|photo| photo.attribute("path"))),
        ..Project::from(reconstruction)
    })
}

fn read_psx(path: &Path, named: &str) -> Result<Project, FileError> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let project = below(path, &named.replace("{projectname}", &stem))?;
    if !project.is_file() {
        let name = project.strip_prefix(path.parent().unwrap_or(Path::new("")));
        let what = format!("its '{}' is not there", name.unwrap_or(&project).display());
        return Err(FileError::new(path, Fault::new(what, COPY)));
    }
    let text = read_document(&project)?;
    let document = parse(&text).map_err(|fault| FileError::new(&project, fault))?;
    let root = document.root_element();
    let Some(list) = child(root, "chunks") else {
        return Err(FileError::new(path, Fault::new("it has no chunk", ALIGN)));
    };
    let mut chunks: Vec<Node<'_, '_>> = children(list, "chunk").collect();
    let count = chunks.len();
    // The active one first.
    let active = list.attribute("active_id");
    chunks.sort_by_key(|chunk| active.is_none() || chunk.attribute("id") != active);
    for chunk in chunks {
        let chunk = below(&project, chunk.attribute("path").unwrap_or_default())?;
        let text = read_document(&chunk)?;
        let at = |fault| FileError::new(&chunk, fault);
        let document = parse(&text).map_err(at)?;
        if has_aligned(document.root_element()) {
            return read_chunk_file(&chunk, document.root_element(), count);
        }
    }
    Err(FileError::new(
        path,
        Fault::new("it holds no aligned photo", ALIGN),
    ))
}

/// Reads the chunk of a chunk.zip, one of `count`, with its first frame.
fn read_chunk_file(path: &Path, chunk: Node<'_, '_>, count: usize) -> Result<Project, FileError> {
    let at = |fault| FileError::new(path, fault);
    let frames: Vec<_> = child(chunk, "frames")
        .map(|frames| children(frames, "frame").collect())
        .unwrap_or_default();
    let mut warnings = Vec::new();
    let named = frames.first().and_then(|frame| frame.attribute("path"));
    let mut frame_text = None;
    if let Some(named) = named {
        let frame = below(path, named)?;
        if frame.is_file() {
            frame_text = Some((read_document(&frame)?, frame));
        } else {
            let frame = frame.display();
            warnings.push(format!(
                "{frame} is not there: photos are named by their labels"
            ));
        }
    }
    let mut project = match &frame_text {
        Some((text, frame)) => {
            let document = parse(text).map_err(|fault| FileError::new(frame, fault))?;
            let root = document.root_element();
            let photos = folder_of(frame, paths_of(Some(root)).into_values());
            let tie_points = read_tie_points(frame, root)?;
            let reconstruction = read_chunk(chunk, Some(root), tie_points).map_err(at)?;
            Project {
                photos,
                ..Project::from(reconstruction)
            }
        }
        None => Project::from(read_chunk(chunk, None, None).map_err(at)?),
    };
    if frames.len() > 1 {
        let count = frames.len();
        warnings.push(format!("it has {count} frames; only the first is read"));
    }
    if count > 1 {
        warnings.push(one_of_chunks(chunk, count));
    }
    project.reconstruction.warnings.extend(warnings);
    Ok(project)
}

/// The tie points of a frame, where they were copied along.
fn read_tie_points(path: &Path, frame: Node<'_, '_>) -> Result<Option<TiePoints>, FileError> {
    let named = child(frame, "point_cloud").and_then(|cloud| cloud.attribute("path"));
    let Some(named) = named else {
        return Ok(None);
    };
    let path = below(path, named)?;
    if !path.is_file() {
        return Ok(None);
    }
    let text = read_document(&path)?;
    let document = parse(&text).map_err(|fault| FileError::new(&path, fault))?;
    let mut archive = open_archive(&path)?;
    Ok(Some(TiePoints::read(&mut archive, document.root_element())))
}

/// The file that another one names relative to its own folder, and that lies below it.
fn below(file: &Path, named: &str) -> Result<PathBuf, FileError> {
    let named = PathBuf::from(named.replace('\\', "/"));
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if named.as_os_str().is_empty() || !named.components().all(inside) {
        let what = format!("it names the file '{}'", named.display());
        return Err(FileError::new(file, Fault::new(what, COPY)));
    }
    Ok(file.parent().unwrap_or(Path::new("")).join(named))
}

/// The folder in which most of the photos lie, where it is there; their paths are relative to the
/// folder of `file`.
fn folder_of<'a>(file: &Path, paths: impl Iterator<Item = &'a str>) -> Option<PathBuf> {
    let mut folders: BTreeMap<PathBuf, usize> = BTreeMap::new();
    for path in paths {
        let path = path.replace('\\', "/");
        let folder = Path::new(path.strip_prefix("file://").unwrap_or(&path)).parent();
        if let Some(folder) = folder {
            *folders.entry(folder.to_owned()).or_default() += 1;
        }
    }
    let (folder, _) = folders.into_iter().max_by_key(|(_, count)| *count)?;
    let folder = file.parent().unwrap_or(Path::new("")).join(folder);
    folder.is_dir().then_some(folder)
}

/// The doc.xml of a zip file.
fn read_document(path: &Path) -> Result<String, FileError> {
    read_entry(path, LARGEST)
}

fn open_archive(path: &Path) -> Result<ZipArchive<BufReader<File>>, FileError> {
    ZipArchive::new(BufReader::new(open_file(path)?))
        .map_err(|error| unreadable(path, &error.to_string()))
}

fn read_entry(path: &Path, largest: u64) -> Result<String, FileError> {
    let mut archive = open_archive(path)?;
    let entry = archive
        .by_name("doc.xml")
        .map_err(|error| unreadable(path, &error.to_string()))?;
    let mut bytes = Vec::new();
    entry
        .take(largest + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| unreadable(path, &error.to_string()))?;
    if bytes.len() as u64 > largest {
        let what = format!("its doc.xml inflates to more than {} MB", largest >> 20);
        let remedy = "export the cameras as XML (File > Export > Export Cameras)";
        return Err(FileError::new(path, Fault::new(what, remedy)));
    }
    let text = text_from_bytes(&bytes).map_err(|fault| FileError::new(path, fault))?;
    Ok(text.to_owned())
}

fn unreadable(path: &Path, error: &str) -> FileError {
    let what = format!("it cannot be unpacked ({error})");
    FileError::new(path, Fault::new(what, "copy the project again"))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;

    fn zipped(path: &Path, name: &str, content: &[u8]) {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mut writer = ZipWriter::new(std::fs::File::create(path).unwrap());
        writer
            .start_file(name, SimpleFileOptions::default())
            .unwrap();
        writer.write_all(content).unwrap();
        writer.finish().unwrap();
    }

    const PSX: &str = "<?xml version=\"1.0\"?>\r\n<document version=\"1.2.0\" path=\"{projectname}.files/project.zip\"/>";
    const PROJECT: &str = "<document><chunks active_id=\"1\"><chunk id=\"0\" path=\"0/chunk.zip\"/>\
        <chunk id=\"1\" path=\"1/chunk.zip\"/><chunk id=\"2\" path=\"2/chunk.zip\"/></chunks></document>";
    const POSE: &str = "<transform>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</transform>";

    fn chunk(label: &str, transform: &str) -> String {
        format!(
            "<chunk label=\"{label}\"><sensors><sensor id=\"0\" type=\"frame\">\
             <calibration><resolution width=\"40\" height=\"30\"/><f>50</f></calibration></sensor></sensors>\
             <cameras><camera id=\"0\" sensor_id=\"0\" label=\"one\">{transform}</camera>\
             <camera id=\"3\" sensor_id=\"0\" label=\"two\">{transform}</camera></cameras>\
             <frames><frame path=\"0/frame.zip\"/><frame path=\"1/frame.zip\"/></frames></chunk>"
        )
    }

    fn project(folder: &Path) -> PathBuf {
        let psx = folder.join("Pile 1.psx");
        std::fs::write(&psx, PSX).unwrap();
        let files = folder.join("Pile 1.files");
        zipped(&files.join("project.zip"), "doc.xml", PROJECT.as_bytes());
        zipped(
            &files.join("0/chunk.zip"),
            "doc.xml",
            chunk("a", POSE).as_bytes(),
        );
        // The active chunk has not been aligned yet.
        zipped(
            &files.join("1/chunk.zip"),
            "doc.xml",
            chunk("b", "").as_bytes(),
        );
        let frame = "<frame><cameras><camera camera_id=\"0\"><photo path=\"..\\..\\..\\My photos/A.JPG\"/></camera>\
            <camera camera_id=\"3\"><photo path=\"../../../My photos/B.JPG\"/></camera></cameras></frame>";
        zipped(&files.join("0/0/frame.zip"), "doc.xml", frame.as_bytes());
        psx
    }

    #[test]
    fn a_project_of_several_chunks() {
        let folder = tempfile::tempdir().unwrap();
        let psx = project(folder.path());
        let found = read_project(&psx).unwrap();
        let names: Vec<_> = found
            .reconstruction
            .photos
            .iter()
            .map(|p| p.name.as_str())
            .collect();
        assert_eq!(names, ["A.JPG", "B.JPG"]);
        assert_eq!(found.photos, None);
        let warnings = found.reconstruction.warnings.join("\n");
        assert!(
            warnings.contains("3 chunks") && warnings.contains("'a'"),
            "{warnings}"
        );
        assert!(warnings.contains("2 frames"), "{warnings}");
        std::fs::create_dir(folder.path().join("My photos")).unwrap();
        let photos = read_project(&psx).unwrap().photos.unwrap();
        assert!(
            photos.ends_with("Pile 1.files/0/0/../../../My photos"),
            "{photos:?}"
        );
        // Without the frame the labels are all there is.
        std::fs::remove_file(folder.path().join("Pile 1.files/0/0/frame.zip")).unwrap();
        let found = read_project(&psx).unwrap().reconstruction;
        assert_eq!(found.photos[1].name, "two");
        assert!(found.warnings.join("\n").contains("named by their labels"));
    }

    /// A point 10 in front of both cameras, which look along the chunk's z from (5, 6, 7): in the
    /// middle of both images, where the first one measures 3 px to the right of it.
    #[test]
    fn tie_points_with_their_projections() {
        let ply = |properties: &str, rows: &str| {
            let count = rows.lines().count();
            format!("ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n{rows}")
        };
        let xyz = "property float x\nproperty float y\nproperty float z\nproperty int id\n";
        let xy = "property float x\nproperty float y\nproperty float size\nproperty int id\n";
        let list = "<point_cloud version=\"1.7.0\"><tracks path=\"tracks.ply\"/><points path=\"points0.ply\"/>\
            <projections camera_id=\"0\" path=\"p0.ply\"/><projections camera_id=\"3\" path=\"p3.ply\"/>\
            <projections camera_id=\"4\" path=\"p4.ply\"/></point_cloud>";
        let folder = tempfile::tempdir().unwrap();
        let psx = project(folder.path());
        let files = folder.path().join("Pile 1.files/0/0");
        let frame = "<frame><cameras/><point_cloud path=\"point_cloud/point_cloud.zip\"/></frame>";
        zipped(&files.join("frame.zip"), "doc.xml", frame.as_bytes());
        let path = files.join("point_cloud/point_cloud.zip");
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mut writer = ZipWriter::new(File::create(&path).unwrap());
        for (name, content) in [
            ("doc.xml", list.to_owned()),
            ("points0.ply", ply(xyz, "5 6 17 42\n1 2 3 7\n")),
            ("p0.ply", ply(xy, "23 15 1 42\n1 1 1 99\n")),
            ("p3.ply", ply(xy, "20 15 1 42\n")),
            (
                "p4.ply",
                "ply\nformat ascii 1.0\nproperty uint64 keypoint\n".to_owned(),
            ),
        ] {
            writer
                .start_file(name, SimpleFileOptions::default())
                .unwrap();
            writer.write_all(content.as_bytes()).unwrap();
        }
        writer.finish().unwrap();
        let found = read_project(&psx).unwrap().reconstruction;
        assert_eq!((found.cloud.points.len(), found.observations.len()), (2, 2));
        assert_eq!(found.median_reprojection_px(), Some(1.5));
        let warnings = found.warnings.join("\n");
        assert!(warnings.contains("not all read: 'p4.ply'"), "{warnings}");
    }

    #[test]
    fn what_is_missing_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let psx = project(folder.path());
        let files = folder.path().join("Pile 1.files");
        let error = |psx: &Path| read_project(psx).unwrap_err().to_string();
        zipped(&files.join("0/chunk.zip"), "other.xml", b"");
        assert!(
            error(&psx).contains("0/chunk.zip: it cannot be unpacked"),
            "{}",
            error(&psx)
        );
        std::fs::write(files.join("0/chunk.zip"), b"PK no zip").unwrap();
        assert!(
            error(&psx).contains("cannot be unpacked"),
            "{}",
            error(&psx)
        );
        for outside in ["../x.zip", "/etc/passwd", ""] {
            let list = PROJECT.replace("0/chunk.zip", outside);
            zipped(&files.join("project.zip"), "doc.xml", list.as_bytes());
            assert!(error(&psx).contains("it names the file"), "{}", error(&psx));
        }
        std::fs::remove_dir_all(&files).unwrap();
        assert_eq!(
            error(&psx),
            format!(
                "{}: its 'Pile 1.files/project.zip' is not there; {COPY}",
                psx.display()
            )
        );
    }

    #[test]
    fn a_psz_is_one_document() {
        let folder = tempfile::tempdir().unwrap();
        let psz = folder.path().join("old.psz");
        let text = chunk("a", POSE).replace(
            "<frame path=\"0/frame.zip\"/>",
            "<frame id=\"0\"><cameras><camera camera_id=\"3\"><photo path=\"p/B.JPG\"/></camera></cameras></frame>",
        );
        let text = format!("<document version=\"1.2.0\"><chunks>{text}</chunks></document>");
        zipped(&psz, "doc.xml", text.as_bytes());
        std::fs::create_dir(folder.path().join("p")).unwrap();
        let found = read_project(&psz).unwrap();
        assert_eq!(found.reconstruction.photos[0].name, "one");
        assert_eq!(found.reconstruction.photos[1].name, "B.JPG");
        assert_eq!(found.photos, Some(folder.path().join("p")));
    }

    #[test]
    fn a_zip_bomb_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let bomb = folder.path().join("b.psz");
        zipped(&bomb, "doc.xml", &vec![b' '; 10 << 20]);
        assert!(std::fs::metadata(&bomb).unwrap().len() < 20_000);
        let error = read_entry(&bomb, 1 << 20).unwrap_err().to_string();
        assert!(error.contains("inflates to more than 1 MB"), "{error}");
    }
}

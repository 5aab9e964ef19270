//! What goes out: the scales of a flight as a table, CSV and JSON, the folder for Split-Desktop, and
//! what is learnt from size distributions.

mod drawing;
mod flight_files;
mod flight_plan;
mod flight_sheet;
mod flown_figure;
mod flown_report;
mod fragments;
mod geo_tags;
mod html_page;
mod map_places;
mod markup;
mod masks;
mod measured;
mod missions;
mod photo_columns;
mod photo_file_names;
mod plan;
mod reconstruction_report;
mod rectified;
mod report_object;
mod scale_map;
mod scale_report;
mod scales_csv;
mod scales_json;
mod scales_table;
mod season;
mod size_distributions;
mod split_desktop;
mod tiff_pages;

use fragscale_core::{
    camera, fault, files, flight, geodesy, geometry, jobs, numbers, picture, scale, surface,
    survey, units,
};
use fragscale_delineation as delineation;
use fragscale_fragmentation as fragmentation;

pub use drawing::DrawingFormat;
pub use flight_files::{Orientation, PoseRow, StatedDeviations, laz, ply, poses_csv};
pub use flight_plan::{PlanReport, kinds_in_words, plan_csv, plan_json, plan_table, plan_warnings};
pub use flight_sheet::{FlightSheet, flight_sheet};
pub use flown_figure::FlownFigure;
pub use flown_report::{
    FlownReport, flown_csv, flown_json, flown_summary, flown_table, flown_warnings,
};
pub use fragments::{
    FRAGMENT_TABLES, FragmentSizes, FragmentTables, MassWay, MeasuredPhoto, OutlinedFiles,
    PhotoOfSizes, PhotoOutlined, curves_csv, distribution_csv, fragment_tables, label_png,
    labels_png, left_over, outlined_files,
};
pub use geo_tags::crs_in_words;
pub use map_places::MapPlaces;
pub use masks::{
    CocoFile, CvatFile, OUTLINE_ENDINGS, fragments_geojson, labelme_json, labels_tiff,
};
pub use measured::{
    MeasuredUnit, PointsReport, ProfileReport, VolumeReport, percent, points_csv, points_table,
    profile_csv, profile_json, profile_table, profile_warnings, stone_sides, volume_csv,
    volume_json, volume_table, volume_warnings,
};
pub use missions::{
    MissionFiles, MissionFormat, WrittenMission, flights_for, mission_files, write_missions,
};
pub use photo_columns::{ColumnKind, ColumnValue, PHOTO_COLUMNS, PhotoColumn};
pub use photo_file_names::photo_file_stems;
pub use plan::{
    Grid, GridLine, GroundOf, MOST_MAP_PIXELS, MapFrame, MeasuredOutline, PhotoPixels, Plan,
    PlanBar, PlanFormat, PlanGround, PlanInks, PlanPhoto, PlanRequest, RoomForNames, ground,
    taken_in_words,
};
pub use reconstruction_report::{
    OffReceiver, ReconstructionReport, SeenPoint, SolvedCamera, SolvedPhoto, reconstruction_report,
};
pub use rectified::{RectifiedFormat, RectifiedPhoto};
pub use report_object::{PointCloudScale, ReportObject};
pub use scale_map::{MapLayer, ScaleMap, scale_map_png, scale_map_tiff};
pub use scale_report::{PhotoLine, ScaleReport};
pub use scales_csv::scales_csv;
pub use scales_json::scales_json;
pub use scales_table::scales_table;
pub use season::{
    FlightFindings, FoundSize, SeasonReport, SeasonRow, SizeShift, VerdictCounts, season_csv,
    season_json_line, season_json_lines, season_page, season_table, size_text,
};
pub use size_distributions::{
    AnovaReport, Band, ComparisonReport, Dash, FigureContents, FigureFormat, FigureStyle,
    FitReport, FittedCurve, FittedDistribution, Marker, Panel, Series, SizeAxis, SizeTick,
    anova_csv, anova_json, anova_table, comparison_csv, comparison_json, comparison_notes,
    comparison_report, comparison_text, effort_csv, effort_json, effort_text, figure_of_comparison,
    figure_of_fits, figure_png, figure_svg, fit_csv, fit_csv_warnings, fit_json, fit_table,
    points_of_curves_csv,
};
pub use split_desktop::{
    ExportRequest, ExportSummary, Provenance, Replace, export_folders, export_for_split_desktop,
    other_flight_in,
};

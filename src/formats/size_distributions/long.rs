//! One line a point.

use super::DistributionColumns;
use crate::fault::Fault;
use crate::formats::table::{NumberRepairs, Table};
use crate::fragmentation::{DistributionSet, LabelledDistribution, Labels, SizeDistribution};
use crate::units::LengthUnit;

/// Reads the points of each curve.
pub(super) fn read(
    table: &Table,
    columns: &DistributionColumns,
) -> Result<(DistributionSet, Vec<String>), Fault> {
    let column =
        |named: &Option<String>, name: &str| table.column(named.as_deref().unwrap_or(name));
    let size = column(&columns.size, "size_mm")?;
    let passing = column(&columns.passing, "percent_passing")?;
    let labels = [
        column(&columns.method, "method").ok(),
        column(&columns.trial, "trial").ok(),
        column(&columns.photo, "photo").ok(),
    ];
    let mut repairs = NumberRepairs::default();
    let mut curves: Vec<(Labels, Vec<[f64; 2]>)> = Vec::new();
    for row in table.rows() {
        let [method, trial, photo] =
            labels.map(|column| column.map_or("", |column| row.cell(column)).to_owned());
        let labels = Labels {
            method,
            trial,
            photo,
        };
        let point = [
            table.number(row, size, &mut repairs)?,
            table.number(row, passing, &mut repairs)?,
        ];
        let [Some(size), Some(percent)] = point else {
            continue;
        };
        match curves.iter_mut().find(|(known, _)| *known == labels) {
            Some((_, points)) => points.push([size, percent]),
            None => curves.push((labels, vec![[size, percent]])),
        }
    }
    let mut set = DistributionSet {
        unit: columns.unit.unwrap_or(LengthUnit::Millimetre),
        curves: Vec::new(),
    };
    for (labels, points) in curves {
        set.curves.push(LabelledDistribution {
            labels,
            weight: None,
            distribution: SizeDistribution::new(points)?,
        });
    }
    Ok((set, repairs.warnings()))
}

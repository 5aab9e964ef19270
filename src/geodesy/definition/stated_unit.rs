//! The unit that a well-known text states, whether its place on the Earth is known or not.

use crate::geodesy::wkt::Node;

/// The length in metres of the unit that a WKT states for a plane system, also for one that is tied to
/// no place on the Earth (LOCAL_CS, ENGCRS) or not understood. `None` for other texts.
pub fn stated_unit_metres(text: &str) -> Option<f64> {
    fn of(node: &Node) -> Option<f64> {
        match node.keyword.as_str() {
            "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" | "PROJCS" | "PROJCRS" | "PROJECTEDCRS" => {
                node.length_unit()
            }
            "COMPD_CS" | "COMPOUNDCRS" => node.nodes().find_map(of),
            "BOUNDCRS" => node.child(&["SOURCECRS"])?.nodes().find_map(of),
            _ => None,
        }
    }
    let roots = Node::parse(text.trim()).ok()?;
    let unit = roots.iter().find_map(of)?;
    (unit.is_finite() && unit > 0.0).then_some(unit)
}

#[cfg(test)]
mod tests {
    use super::stated_unit_metres;
    use crate::geodesy::definition::tests::UTM33;

    #[test]
    fn units_of_systems_without_a_place() {
        let local = r#"LOCAL_CS["Local Coordinates (m)",LOCAL_DATUM["Local Datum",0],UNIT["metre",1,AUTHORITY["EPSG","9001"]]]"#;
        assert_eq!(stated_unit_metres(local), Some(1.0));
        let compound = format!(
            r#"COMPD_CS["a",{},VERT_CS["h",VERT_DATUM["x",2005],UNIT["metre",1]]]"#,
            local.replace("\"metre\",1,", "\"US survey foot\",0.304800609601219,")
        );
        assert_eq!(stated_unit_metres(&compound), Some(0.304_800_609_601_219));
        let wkt2 = r#"ENGCRS["pit",EDATUM["pit"],CS[Cartesian,2],AXIS["x",east,ORDER[1],LENGTHUNIT["foot",0.3048]],AXIS["y",north,ORDER[2],LENGTHUNIT["foot",0.3048]]]"#;
        assert_eq!(stated_unit_metres(wkt2), Some(0.3048));
        assert_eq!(stated_unit_metres(UTM33), Some(1.0));
        let silent = r#"LOCAL_CS["a",LOCAL_DATUM["b",0]]"#;
        let degrees = r#"GEOGCS["WGS 84",DATUM["a",SPHEROID["b",1,2]],UNIT["degree",0.0174]]"#;
        for none in [
            silent,
            degrees,
            "",
            "EPSG:32633",
            "LOCAL_CS[\"a\",UNIT[\"m\",0]]",
        ] {
            assert_eq!(stated_unit_metres(none), None, "{none}");
        }
    }
}

use std::fmt::Write;

use cosmorama::lighting::{ColourTable, TableAngle};
use cosmorama::raster::Rgba;
use cosmorama::sphere::{Angle, Orientation};

use super::Colour;

/// Reads a table of colours from CSV, as [`colour_table_csv`] prints it: `elevation,red,green,blue` or `azimuth,red,green,blue`, a
/// line for each angle.
///
/// ```
/// use cosmorama::sphere::{Direction, Orientation};
///
/// let text = "elevation,red,green,blue\n-90,0,0,0\n90,1,1,1\n";
/// let table = cosmorama_spec::colour_table_of_csv(text, Orientation::IDENTITY)?;
/// assert_eq!(table.at(Direction::FRONT), [0.5; 3]);
/// assert_eq!(cosmorama_spec::colour_table_csv(&table).lines().next(), text.lines().next());
/// # Ok::<(), String>(())
/// ```
///
/// # Errors
/// When a line is not what it should be, with its number.
pub fn colour_table_of_csv(text: &str, frame: Orientation) -> Result<ColourTable, String> {
    let mut lines = (1..).zip(text.lines().map(str::trim)).filter(|(_, line)| !line.is_empty());
    let head = lines.next().map_or("", |(_, line)| line);
    let angle = match head {
        "elevation,red,green,blue" => TableAngle::Elevation,
        "azimuth,red,green,blue" => TableAngle::Azimuth,
        _ => {
            return Err(format!(
                "the first line is '{}', where elevation,red,green,blue or azimuth,red,green,blue was expected",
                head.chars().take(60).collect::<String>()
            ));
        }
    };
    let stop = |(number, line): (usize, &str)| {
        let numbers: Option<Vec<f64>> = line.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[degrees, red, green, blue]) => Ok((Angle::from_degrees(degrees), [red, green, blue])),
            _ => Err(format!("line {number}: expected four numbers, as in 30,0.2,0.4,0.8")),
        }
    };
    let stops = lines.map(stop).collect::<Result<_, _>>()?;
    ColourTable::new((angle, frame), stops).map_err(|error| error.to_string())
}

/// Reads a table of colours from stops, as in `-90=#302010;0=white;90=0.1,0.3,1`: an angle in degrees and a colour each.
///
/// # Errors
/// When a stop is not what it should be.
pub fn colour_table_of_stops(text: &str, (angle, frame): (TableAngle, Orientation)) -> Result<ColourTable, String> {
    let stop = |stop: &str| {
        let expected = || format!("'{stop}' is no stop; expected DEGREES=COLOUR, as in 0=white or 90=0.1,0.3,1");
        let (degrees, colour) = stop.split_once('=').ok_or_else(expected)?;
        let degrees: f64 = degrees.trim().parse().map_err(|_| expected())?;
        let Colour(Rgba([red, green, blue, alpha])) = colour.trim().parse()?;
        if alpha != 1.0 {
            return Err(format!("'{stop}': colours of a table are opaque"));
        }
        Ok((Angle::from_degrees(degrees), [red, green, blue].map(f64::from)))
    };
    let stops = text.split(';').filter(|stop| !stop.trim().is_empty()).map(stop).collect::<Result<_, _>>()?;
    ColourTable::new((angle, frame), stops).map_err(|error| error.to_string())
}

/// Prints a table of colours as CSV.
pub fn colour_table_csv(table: &ColourTable) -> String {
    let name = match table.angle() {
        TableAngle::Elevation => "elevation",
        TableAngle::Azimuth => "azimuth",
    };
    let mut text = format!("{name},red,green,blue\n");
    for (angle, [red, green, blue]) in table.stops() {
        // Writing into a string does not fail.
        let _ = writeln!(text, "{},{red},{green},{blue}", angle.degrees());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_as_they_are_printed() {
        let frame = Orientation::IDENTITY;
        for angle in [TableAngle::Elevation, TableAngle::Azimuth] {
            let table = colour_table_of_stops("-80=#302010; 0=white;90=0.1,0.3,1;", (angle, frame)).expect("a table");
            assert_eq!(table.stops()[2].1, [0.1f32, 0.3, 1.0].map(f64::from));
            let again = colour_table_of_csv(&colour_table_csv(&table), frame).expect("a table");
            assert_eq!(colour_table_csv(&again), colour_table_csv(&table));
            assert_eq!(again.angle(), angle);
        }
    }

    #[test]
    fn mistakes_are_named() {
        let frame = Orientation::IDENTITY;
        let stops = |text: &str| colour_table_of_stops(text, (TableAngle::Elevation, frame)).expect_err(text);
        assert!(stops("0:white").contains("DEGREES=COLOUR"));
        assert!(stops("0=whit").contains("whit"));
        assert!(stops("0=transparent").contains("opaque"));
        assert!(stops("0=white;-10=black").contains("angles must grow, but -10° follows 0°"));
        assert!(stops("95=white").contains("outside −90° to 90°"));
        assert!(stops(";").contains("a table of 0 colours"));
        let csv = |text: &str| colour_table_of_csv(text, frame).expect_err(text);
        assert!(csv("a,b\n").contains("where elevation,red,green,blue"));
        assert!(csv("azimuth,red,green,blue\n\n0,1,2\n").contains("line 3: expected four numbers"));
        assert!(csv("azimuth,red,green,blue\n0,1,2,inf\n").contains("not finite"));
    }
}

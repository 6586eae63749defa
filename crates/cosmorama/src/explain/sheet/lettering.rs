//! Letters as strokes, so that figures look the same on machines without fonts.

/// Rows of the letters' grid from the top of a capital to the baseline.
const CAPITAL: f64 = 6.0;

/// Columns between two letters.
const GAP: f64 = 1.8;

/// Columns of a space.
const SPACE: f64 = 2.2;

/// Strokes in the place of a character without a drawing.
const UNKNOWN: &str = "0040460600";

/// Returns the strokes of a character: polylines, separated by spaces, of points written as two digits, column and row.
fn strokes(character: char) -> Option<&'static str> {
    Some(match character {
        '0' | 'O' => "103041453616050110",
        '1' => "012026",
        '2' => "01103041420646",
        '3' => "01103041423323 334445361605",
        '4' => "36300444",
        '5' => "400003334445361605",
        '6' => "4130100105163645443303",
        '7' => "004016",
        '8' => "103041423313020110 1304051636454433",
        '9' => "0516364541301001021343",
        'A' => "062046 1434",
        'B' => "00063645443303 0030414233",
        'C' => "4130100105163645",
        'D' => "00063645413000",
        'E' => "40000646 0333",
        'F' => "400006 0333",
        'G' => "41301001051636454323",
        'H' => "0006 4046 0343",
        'I' => "0006",
        'J' => "4045361605",
        'K' => "0006 4004 1346",
        'L' => "000646",
        'M' => "0600234046",
        'N' => "06004640",
        'P' => "06003041423303",
        'Q' => "103041453616050110 2446",
        'R' => "06003041423303 2346",
        'S' => "413010010213334445361605",
        'T' => "0040 2026",
        'U' => "000516364540",
        'V' => "002640",
        'W' => "0016325660",
        'X' => "0046 4006",
        'Y' => "002340 2326",
        'Z' => "00400646",
        'a' => "4246 4332120305163645",
        'b' => "0006 0312324345361605",
        'c' => "4332120305163645",
        'd' => "4046 4332120305163645",
        'e' => "04444332120305163645",
        'f' => "30201116 0232",
        'g' => "4247381807 4332120305163645",
        'h' => "0006 0312324346",
        'i' => "0206 0000",
        'j' => "22271808 2020",
        'k' => "0006 3205 1436",
        'l' => "000516",
        'm' => "0206 0312223336 3342526366",
        'n' => "0206 0312324346",
        'o' => "123243453616050312",
        'p' => "0208 0312324345361605",
        'q' => "4248 4332120305163645",
        'r' => "0206 031222",
        's' => "43321203143445361605",
        't' => "10152636 0232",
        'u' => "0205163645 4246",
        'v' => "022642",
        'w' => "0216325662",
        'x' => "0246 4206",
        'y' => "0226 4218",
        'z' => "02420646",
        '-' | '–' | '−' => "0434",
        '_' => "0747",
        '.' => "0606",
        ',' => "1607",
        ':' => "0303 0606",
        ';' => "1313 1607",
        '\'' => "0002",
        '#' => "1016 3036 0242 0444",
        '&' => "4602111021310405163644",
        '+' => "0444 2226",
        '=' => "0343 0545",
        '/' => "4006",
        '%' => "4006 0010110100 3545463635",
        '×' => "0335 3305",
        '°' => "1021120110",
        '²' => "0020210323",
        '(' => "10020416",
        ')' => "00121406",
        '→' => "0464 534455",
        _ => return None,
    })
}

/// Returns a line of text as polylines, in units of the capitals' height: x to the right from the line's start, y down
/// from the baseline. Also returns the total width.
pub fn polylines(text: &str) -> (Vec<Vec<(f64, f64)>>, f64) {
    let (mut lines, mut x) = (Vec::new(), 0.0);
    for character in text.chars() {
        if character == ' ' {
            x += SPACE;
            continue;
        }
        let mut width = 0f64;
        for stroke in strokes(character).unwrap_or(UNKNOWN).split(' ') {
            let digit = |byte: u8| f64::from(byte - b'0');
            let points = stroke.as_bytes().chunks_exact(2).map(|pair| (digit(pair[0]), digit(pair[1])));
            width = points.clone().fold(width, |width, (column, _)| width.max(column));
            lines.push(points.map(|(column, row)| ((x + column) / CAPITAL, row / CAPITAL - 1.0)).collect());
        }
        x += width + GAP;
    }
    (lines, (x - GAP).max(0.0) / CAPITAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stroke_is_made_of_points_on_the_grid() {
        for character in (' '..='~').chain("–−×°→".chars()) {
            for stroke in strokes(character).unwrap_or(UNKNOWN).split(' ') {
                assert!(stroke.len() >= 4 && stroke.len() % 2 == 0, "{character}: {stroke}");
                assert!(stroke.bytes().all(|byte| (b'0'..=b'8').contains(&byte)), "{character}: {stroke}");
            }
        }
    }

    #[test]
    fn width_grows_with_the_text() {
        let width = |text| polylines(text).1;
        assert!(width("") == 0.0 && width("il") < width("im") && width("a b") > width("ab"));
    }
}

//! Time codes: hours, minutes, seconds and frames on a tape or in a film.

use crate::Ratio;

/// Returns the time code some frames later; `None` if it is not one of this rate. Behind a semicolon, frames 0 and 1 of most
/// minutes are left out (SMPTE ST 12-1), so that codes of 29.97 frames a second follow the clock.
pub(super) fn later(timecode: &str, frames: u64, rate: Ratio) -> Option<String> {
    let base = rate.to_f64().round() as u64;
    let is_dropping = timecode.contains([';', '.']);
    let parts = timecode.split([':', ';', '.']).map(|part| part.parse().ok()).collect::<Option<Vec<u64>>>()?;
    let &[hours, minutes, seconds, frame] = parts.as_slice() else { return None };
    let dropped = if is_dropping { base / 15 } else { 0 };
    if hours > 23
        || minutes > 59
        || seconds > 59
        || base == 0
        || frame >= base
        || (is_dropping && !base.is_multiple_of(30))
    {
        return None;
    }
    let all_minutes = hours * 60 + minutes;
    let skipped = dropped * (all_minutes - all_minutes / 10);
    let minute = 60 * base - dropped;
    let ten = 10 * 60 * base - 9 * dropped;
    let number = ((all_minutes * 60 + seconds) * base + frame - skipped + frames % (144 * ten)) % (144 * ten);
    let (tens, rest) = (number / ten, number % ten);
    // The first minute of ten has all its frames.
    let later = if rest < dropped { 0 } else { (rest - dropped) / minute };
    let code = number + dropped * (9 * tens + later);
    let (seconds, frame) = (code / base, code % base);
    let mark = if is_dropping { ';' } else { ':' };
    Some(format!("{:02}:{:02}:{:02}{mark}{frame:02}", seconds / 3600 % 24, seconds / 60 % 60, seconds % 60))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_count_frames() {
        let later = |code: &str, frames: u64, rate: &str| later(code, frames, Ratio::parse(rate).unwrap());
        let is = |code: &str| Some(code.to_owned());
        assert_eq!(later("01:00:00:00", 0, "25"), is("01:00:00:00"));
        assert_eq!(later("01:00:00:24", 1, "25"), is("01:00:01:00"));
        assert_eq!(later("23:59:59:23", 1, "24000/1001"), is("00:00:00:00"));
        // Codes 00:01:00;00 and ;01 do not exist, 00:10:00;00 does.
        assert_eq!(later("00:00:59;29", 1, "30000/1001"), is("00:01:00;02"));
        assert_eq!(later("00:09:59;29", 1, "30000/1001"), is("00:10:00;00"));
        assert_eq!(later("00:00:00;00", 17_982, "30000/1001"), is("00:10:00;00"));
        assert_eq!(later("00:00:00;00", 107_892, "30000/1001"), is("01:00:00;00"));
        assert_eq!(later("00:00:59;59", 1, "60000/1001"), is("00:01:00;04"));
        for wrong in ["", "1:2:3", "00:00:00:25", "00:61:00:00", "aa:00:00:00"] {
            assert_eq!(later(wrong, 0, "25"), None, "{wrong}");
        }
    }
}

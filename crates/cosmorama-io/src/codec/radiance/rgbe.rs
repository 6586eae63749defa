//! Radiance's pixels, three mantissas with a common exponent in four bytes, and the scan lines made of them.
//!
//! The codec of the `image` crate is not used: it truncates instead of rounding (a bias of half a step), wraps
//! exponents below 2⁻¹²⁸ to huge ones, and its old-style run lengths overflow on hostile files.

use std::io::{self, Read, Write};

/// A pixel as in a file: red, green, blue, exponent.
pub(super) type Rgbe = [u8; 4];

/// Returns the light of a pixel.
pub(super) fn decode([red, green, blue, exponent]: Rgbe) -> [f32; 3] {
    if exponent == 0 {
        return [0.0; 3];
    }
    // In f64, since 2⁻¹³⁵ is not a normal f32.
    let scale = 2.0_f64.powi(i32::from(exponent) - 136);
    [red, green, blue].map(|mantissa| (f64::from(mantissa) * scale) as f32)
}

/// Returns the pixel nearest to a light value; negative light and NaN become zero.
pub(super) fn encode(light: [f32; 3]) -> Rgbe {
    let light = light.map(|c| f64::from(c.max(0.0)));
    let brightest = light[0].max(light[1]).max(light[2]).min(f64::from(f32::MAX));
    if brightest < 2.0_f64.powi(-135) {
        return [0; 4];
    }
    // The power of two above the brightest sample, from bits, since logarithms are not exact.
    let power = ((brightest.to_bits() >> 52) as i32 - 1023) + 1;
    let mantissa = |c: f64, power: i32| (c * 2.0_f64.powi(8 - power)).round();
    // Rounding may reach 256, which is 128 with the next exponent.
    let power = if mantissa(brightest, power) > 255.0 { power + 1 } else { power };
    let power = power.clamp(-127, 127);
    let [red, green, blue] = light.map(|c| mantissa(c, power).min(255.0) as u8);
    [red, green, blue, (power + 128) as u8]
}

/// Returns whether today's run-length encoding permits a width.
fn can_be_run_length_encoded(width: usize) -> bool {
    (8..=0x7fff).contains(&width)
}

/// Reads one scan line in any of its three encodings.
pub(super) fn read_line(source: &mut impl Read, line: &mut [Rgbe]) -> io::Result<()> {
    let first = read_pixel(source)?;
    let [two, also_two, high, low] = first;
    let announced = usize::from(high) << 8 | usize::from(low);
    if two == 2 && also_two == 2 && high < 128 && can_be_run_length_encoded(line.len()) {
        if announced != line.len() {
            return Err(damaged("a scan line of another width"));
        }
        return (0..4).try_for_each(|component| read_component(source, line, component));
    }
    read_plain_line(source, line, first)
}

fn damaged(reason: &'static str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason)
}

fn read_pixel(source: &mut impl Read) -> io::Result<Rgbe> {
    let mut pixel = [0; 4];
    source.read_exact(&mut pixel)?;
    Ok(pixel)
}

fn read_byte(source: &mut impl Read) -> io::Result<u8> {
    let mut byte = [0];
    source.read_exact(&mut byte)?;
    Ok(byte[0])
}

/// Reads one of the four components of a run-length encoded line.
fn read_component(source: &mut impl Read, line: &mut [Rgbe], component: usize) -> io::Result<()> {
    let mut rest = line;
    while !rest.is_empty() {
        let code = usize::from(read_byte(source)?);
        let (count, run) = if code > 128 { (code - 128, Some(read_byte(source)?)) } else { (code, None) };
        if count == 0 || count > rest.len() {
            return Err(damaged("a run longer than its scan line"));
        }
        let (now, later) = rest.split_at_mut(count);
        for pixel in now {
            pixel[component] = match run {
                Some(value) => value,
                None => read_byte(source)?,
            };
        }
        rest = later;
    }
    Ok(())
}

/// Reads a line pixel by pixel, in which 1 1 1 n repeats the last pixel n times (n · 256 after another, and so on).
fn read_plain_line(source: &mut impl Read, line: &mut [Rgbe], first: Rgbe) -> io::Result<()> {
    let mut pixel = first;
    let mut shift = 0;
    let mut done = 0;
    while done < line.len() {
        match pixel {
            [1, 1, 1, count] if done > 0 => {
                let count = usize::from(count).checked_shl(shift).unwrap_or(usize::MAX);
                if shift > 24 || count > line.len() - done {
                    return Err(damaged("a run longer than its scan line"));
                }
                let last = line[done - 1];
                line[done..][..count].fill(last);
                done += count;
                shift += 8;
            }
            _ => {
                line[done] = pixel;
                done += 1;
                shift = 0;
            }
        }
        if done < line.len() {
            pixel = read_pixel(source)?;
        }
    }
    Ok(())
}

/// Writes one scan line, run-length encoded if its width permits.
pub(super) fn write_line(output: &mut impl Write, line: &[Rgbe]) -> io::Result<()> {
    if !can_be_run_length_encoded(line.len()) {
        return line.iter().try_for_each(|pixel| output.write_all(pixel));
    }
    output.write_all(&[2, 2, (line.len() >> 8) as u8, (line.len() & 0xff) as u8])?;
    let mut component_line = Vec::with_capacity(line.len());
    for component in 0..4 {
        component_line.clear();
        component_line.extend(line.iter().map(|pixel| pixel[component]));
        write_component(output, &component_line)?;
    }
    Ok(())
}

/// Shortest run that saves bytes between literals.
const SHORTEST_RUN: usize = 4;

fn write_component(output: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let run_at = |start: usize| bytes[start..].iter().take(127).take_while(|byte| **byte == bytes[start]).count();
    let mut literals = 0;
    let mut at = 0;
    while at < bytes.len() {
        let run = run_at(at);
        if run >= SHORTEST_RUN {
            write_literals(output, &bytes[literals..at])?;
            output.write_all(&[128 + run as u8, bytes[at]])?;
            literals = at + run;
        }
        at += run;
    }
    write_literals(output, &bytes[literals..])
}

fn write_literals(output: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    bytes.chunks(128).try_for_each(|chunk| {
        output.write_all(&[chunk.len() as u8])?;
        output.write_all(chunk)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_normalised_pixel_comes_back() {
        for exponent in 1..=255 {
            for mantissa in 128..=255 {
                let pixel = [mantissa, mantissa / 3, 0, exponent];
                assert_eq!(encode(decode(pixel)), pixel);
            }
        }
    }

    #[test]
    fn light_is_rounded_not_cut() {
        for light in [0.001_f32, 0.3, 0.999_999, 1.0, 7.77, 60_000.0] {
            let error = (decode(encode([light, 0.0, 0.0]))[0] - light).abs();
            assert!(error <= light / 256.0 * 1.001, "{light}");
        }
        assert_eq!(encode([f32::from_bits(0x3f7f_ffff), 0.0, 0.0]), [128, 0, 0, 129]);
    }

    #[test]
    fn extremes() {
        assert_eq!(encode([f32::NAN, -1.0, 0.0]), [0; 4]);
        assert_eq!(encode([1e-45, 0.0, 0.0]), [0; 4]);
        assert_eq!(encode([f32::INFINITY, 0.0, 0.0])[0], 255);
        assert!(decode([255, 255, 255, 255]).iter().all(|c| c.is_finite()));
        assert_eq!(decode(encode([f32::MAX, 0.0, 0.0]))[0], decode([255, 0, 0, 255])[0]);
    }

    #[test]
    fn lines_come_back() {
        for width in [1, 7, 8, 127, 128, 129, 300, 1000] {
            let line: Vec<Rgbe> =
                (0..width).map(|i: usize| [(i / 50) as u8, (i * 7) as u8, (i % 3) as u8, 128]).collect();
            let mut bytes = Vec::new();
            write_line(&mut bytes, &line).unwrap();
            let mut back = vec![[0; 4]; width];
            read_line(&mut bytes.as_slice(), &mut back).unwrap();
            assert_eq!(back, line);
        }
    }

    #[test]
    fn runs_of_the_old_kind() {
        let bytes = [9, 8, 7, 6, 1, 1, 1, 2, 5, 5, 5, 5];
        let mut line = [[0; 4]; 4];
        read_line(&mut &bytes[..], &mut line).unwrap();
        assert_eq!(line, [[9, 8, 7, 6], [9, 8, 7, 6], [9, 8, 7, 6], [5, 5, 5, 5]]);
        let endless = [1_u8, 1, 1, 0].repeat(20);
        assert!(read_line(&mut &endless[..], &mut line).is_err());
    }
}

/// Names of the parameters of i- and p-lines, longer ones first.
const NAMES: [&str; 62] = [
    "TrX", "TrY", "TrZ", "Tpy", "Tpp", "TiX", "TiY", "TiZ", "TiS", "Eev", "Er", "Eb", "Ra", "Rb", "Rc", "Rd", "Re",
    "Va", "Vb", "Vc", "Vd", "Vx", "Vy", "Vm", "Vf", "P0", "P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8", "P9", "w",
    "h", "f", "v", "r", "p", "y", "a", "b", "c", "d", "e", "g", "t", "j", "n", "S", "C", "o", "u", "m", "k", "K", "X",
    "E", "R", "P",
];

/// Parameters of a line in their order, with values as written.
pub(super) struct Line<'a> {
    words: Vec<(&'static str, &'a str)>,
}

/// A value, or the number of the image whose value is used.
pub(super) enum Value {
    Number(f64),
    Of(usize),
}

impl<'a> Line<'a> {
    /// Parses the text after a line's first letter.
    pub(super) fn parse(text: &'a str) -> Result<Self, String> {
        let mut words = Vec::new();
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            let name = NAMES.into_iter().find(|name| rest.starts_with(name));
            let name = name.ok_or_else(|| format!("'{}' is no parameter that is known", first_word(rest)))?;
            let value = &rest[name.len()..];
            let end = match value.strip_prefix('"') {
                Some(quoted) => 2 + quoted.find('"').ok_or("a name that does not end: \" is missing")?,
                None => value.find(char::is_whitespace).unwrap_or(value.len()),
            };
            if words.iter().any(|(earlier, _)| *earlier == name) {
                return Err(format!("{name} is given twice"));
            }
            words.push((name, &value[..end]));
            rest = value[end..].trim_start();
        }
        Ok(Self { words })
    }

    pub(super) fn get(&self, name: &str) -> Option<&'a str> {
        self.words.iter().find(|(found, _)| *found == name).map(|(_, value)| *value)
    }

    /// Returns a number or a reference (`=0`); `None` if the parameter is absent.
    pub(super) fn value(&self, name: &str) -> Result<Option<Value>, String> {
        let Some(text) = self.get(name) else { return Ok(None) };
        let wrong = || format!("{name}{text}: expected a number, or = and the number of an image before it");
        match text.strip_prefix('=') {
            Some(image) => image.parse().map(|image| Some(Value::Of(image))).map_err(|_| wrong()),
            None => {
                let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
                number.map(|number| Some(Value::Number(number))).ok_or_else(wrong)
            }
        }
    }

    /// Returns a number; 0 if the parameter is absent.
    pub(super) fn number(&self, name: &str) -> Result<f64, String> {
        match self.value(name)? {
            None => Ok(0.0),
            Some(Value::Number(number)) => Ok(number),
            Some(Value::Of(_)) => Err(format!("{name}: expected a number here")),
        }
    }

    /// Returns a whole number of pixels.
    pub(super) fn side(&self, name: &str) -> Result<usize, String> {
        let number = self.number(name)?;
        if (1.0..=f64::from(u32::MAX)).contains(&number) && number.fract() == 0.0 {
            return Ok(number as usize);
        }
        Err(format!("{name}{number}: expected a whole number of pixels, more than 0"))
    }

    /// Returns `S` or another crop: left, right, top, bottom in pixels; `None` if it is absent or empty.
    pub(super) fn crop(&self, name: &str) -> Result<Option<[i64; 4]>, String> {
        let Some(text) = self.get(name) else { return Ok(None) };
        let sides: Option<Vec<i64>> = text.split(',').map(|side| side.parse::<i32>().ok().map(i64::from)).collect();
        let sides: Option<[i64; 4]> = sides.and_then(|sides| sides.try_into().ok());
        match sides {
            Some([0, 0, 0, 0]) => Ok(None),
            Some([left, right, top, bottom]) if left < right && top < bottom => Ok(sides),
            _ => Err(format!("{name}{text}: expected LEFT,RIGHT,TOP,BOTTOM in pixels")),
        }
    }
}

fn first_word(text: &str) -> &str {
    text.split_whitespace().next().unwrap_or(text)
}

//! The sea of a run-time package in Rust, without a GPU and without other crates:
//!     fftocean export-sea -o sea
//!     let sea = SeaWaves::open("sea", usize::MAX)?; // every wave
//!     let fast = SeaWaves::open("sea", 500)?; // the strongest, without fast.neglected_rms [m]
//!     let water = sea.at(x, y, t); // the water above a place: water.height, water.normal
//!     let buoy = sea.rest(x0, y0, t); // the water that rests at a place: buoy.x, buoy.y
//! x east, y north, z up, metres, seconds. Bevy: at(p.x, -p.z, t), normal (n[0], n[2], -n[1]).
//! A damaged package is refused by an error that names the file and the rule.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs::File;
use std::io::Read;

const MOST: usize = 1 << 20; // bytes of sea.json
const DEEPEST: usize = 32;

/// A value of JSON; numbers are finite.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(BTreeMap<String, Json>),
}

impl Json {
    pub fn get(&self, key: &str) -> &Json {
        match self {
            Json::Object(entries) => entries.get(key).unwrap_or(&Json::Null),
            _ => &Json::Null,
        }
    }

    pub fn items(&self) -> &[Json] {
        if let Json::List(items) = self {
            items
        } else {
            &[]
        }
    }

    pub fn text(&self) -> &str {
        if let Json::Text(text) = self {
            text
        } else {
            ""
        }
    }

    /// The number, or NaN.
    pub fn number(&self) -> f64 {
        if let Json::Number(number) = self {
            *number
        } else {
            f64::NAN
        }
    }

    fn is_whole(&self, low: f64, high: f64) -> bool {
        (low..=high).contains(&self.number()) && self.number().fract() == 0.0
    }

    fn is_power(&self, most: f64) -> bool {
        self.is_whole(2.0, most) && (self.number() as u64).is_power_of_two()
    }
}

struct Parser<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Parser<'_> {
    fn parse(bytes: &[u8]) -> Result<Json, String> {
        let mut parser = Parser { bytes, at: 0 };
        let value = parser.value(0)?;
        parser.space();
        parser.need(parser.at == bytes.len())?;
        Ok(value)
    }

    fn need(&self, right: bool) -> Result<(), String> {
        must(right, || "sea.json must be JSON".into())
    }

    fn here(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(0)
    }

    fn space(&mut self) {
        while matches!(self.here(), b' ' | b'\n' | b'\r' | b'\t') {
            self.at += 1;
        }
    }

    fn take(&mut self, word: &str) -> bool {
        let same = self.bytes[self.at..].starts_with(word.as_bytes());
        self.at += if same { word.len() } else { 0 };
        same
    }

    fn value(&mut self, depth: usize) -> Result<Json, String> {
        must(depth <= DEEPEST, || format!("sea.json must nest at most {DEEPEST} deep"))?;
        self.space();
        if self.take("{") {
            let mut entries = BTreeMap::new();
            self.space();
            while !self.take("}") {
                if !entries.is_empty() {
                    let comma = self.take(",");
                    self.need(comma)?;
                    self.space();
                }
                let key = self.string()?;
                self.space();
                let colon = self.take(":");
                self.need(colon)?;
                entries.insert(key, self.value(depth + 1)?);
                self.space();
            }
            return Ok(Json::Object(entries));
        }
        if self.take("[") {
            let mut items = Vec::new();
            self.space();
            while !self.take("]") {
                if !items.is_empty() {
                    let comma = self.take(",");
                    self.need(comma)?;
                }
                items.push(self.value(depth + 1)?);
                self.space();
            }
            return Ok(Json::List(items));
        }
        if self.here() == b'"' {
            return Ok(Json::Text(self.string()?));
        }
        for (word, value) in
            [("null", Json::Null), ("true", Json::Bool(true)), ("false", Json::Bool(false))]
        {
            if self.take(word) {
                return Ok(value);
            }
        }
        let start = self.at;
        while matches!(self.here(), b'+' | b'-' | b'.' | b'0'..=b'9' | b'e' | b'E') {
            self.at += 1;
        }
        let word = std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or("");
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        self.need(number.is_some())?;
        Ok(Json::Number(number.unwrap_or(0.0)))
    }

    /// Escapes stay as they are, but for quotes: no key or value that is used here has any.
    fn string(&mut self) -> Result<String, String> {
        let quote = self.take("\"");
        self.need(quote)?;
        let mut made = Vec::new();
        while self.here() != b'"' {
            self.at += usize::from(self.here() == b'\\');
            self.need(self.at < self.bytes.len())?;
            made.push(self.here());
            self.at += 1;
        }
        self.at += 1;
        String::from_utf8(made).map_err(|_| "sea.json must be JSON".into())
    }
}

/// FIPS 180-4.
pub fn sha256(bytes: &[u8]) -> String {
    let primes: Vec<u32> = (2..312).filter(|n| (2..*n).all(|d| n % d != 0)).collect();
    let part = |x: f64| (x.fract() * 4294967296.0) as u32;
    let k: Vec<u32> = primes.iter().map(|p| part(f64::from(*p).cbrt())).collect();
    let mut h: Vec<u32> = primes[..8].iter().map(|p| part(f64::from(*p).sqrt())).collect();
    let mut data = bytes.to_vec();
    data.push(128);
    data.resize((data.len() + 71) / 64 * 64 - 8, 0);
    data.extend((bytes.len() as u64 * 8).to_be_bytes());
    for block in data.chunks(64) {
        let mut w: Vec<u32> = block
            .chunks(4)
            .map(|four| u32::from_be_bytes([four[0], four[1], four[2], four[3]]))
            .collect();
        for i in 16..64 {
            let (p, q) = (w[i - 15], w[i - 2]);
            let s = p.rotate_right(7) ^ p.rotate_right(18) ^ (p >> 3);
            let t = q.rotate_right(17) ^ q.rotate_right(19) ^ (q >> 10);
            w.push(w[i - 16].wrapping_add(s).wrapping_add(w[i - 7]).wrapping_add(t));
        }
        let mut v = h.clone();
        for i in 0..64 {
            let s = v[4].rotate_right(6) ^ v[4].rotate_right(11) ^ v[4].rotate_right(25);
            let choice = (v[4] & v[5]) ^ (!v[4] & v[6]);
            let one = [s, choice, k[i], w[i]].iter().fold(v[7], |sum, x| sum.wrapping_add(*x));
            let t = v[0].rotate_right(2) ^ v[0].rotate_right(13) ^ v[0].rotate_right(22);
            let majority = (v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]);
            v.rotate_right(1);
            v[0] = one.wrapping_add(t).wrapping_add(majority);
            v[4] = v[4].wrapping_add(one);
        }
        h = h.iter().zip(v).map(|(a, b)| a.wrapping_add(b)).collect();
    }
    h.iter().map(|word| format!("{word:08x}")).collect()
}

#[derive(Clone, Copy, Debug)]
pub struct Water {
    pub x0: f64, // place at rest [m]
    pub y0: f64,
    pub x: f64, // place now [m]
    pub y: f64,
    pub height: f64,
    pub normal: [f64; 3],   // unit, up
    pub residual: f64,      // distance from the place that was asked for [m]
    pub jacobian: f64,      // 0 or less: in a fold, one of several
    pub gradient: [f64; 3], // of the place now: dx/dx0, dx/dy0 = dy/dx0, dy/dy0
}

/// A wave's height is the real part of (re + i im) e^(i phase).
#[derive(Clone, Copy, Debug)]
pub struct Wave {
    pub tile: usize,
    pub mx: i32,
    pub my: i32,
    pub cycles: u32,
    pub re: f64,
    pub im: f64,
    pub kx: f64, // [rad/m]
    pub ky: f64,
    pub f: f64, // 1 / (k tanh(k depth)) [m]
}

impl Wave {
    fn square(&self) -> f64 {
        self.re * self.re + self.im * self.im
    }
}

pub struct SeaWaves {
    pub document: Json,
    pub waves: Vec<Wave>,
    pub sizes: Vec<[f64; 2]>, // of the tiles [m]
    pub period: f64,          // of the loop [s]
    pub choppiness: f64,
    pub neglected_rms: f64, // of the height of the waves that are left out [m]
}

impl SeaWaves {
    pub fn open(folder: &str, strongest: usize) -> Result<Self, String> {
        Self::new(
            |name, limit| {
                let file = File::open(format!("{folder}/{name}")).ok()?;
                let mut bytes = Vec::new();
                file.take(limit as u64 + 1).read_to_end(&mut bytes).ok()?;
                Some(bytes)
            },
            strongest,
        )
    }

    /// `read` gives a file's bytes, at most so many and one more; None: it does not exist.
    pub fn new(
        read: impl Fn(&str, usize) -> Option<Vec<u8>>,
        strongest: usize,
    ) -> Result<Self, String> {
        let document = parsed(read("sea.json", MOST))?;
        let (period, choppiness) = (document.get("loop"), document.get("choppiness"));
        must(period.number() > 0.0, || "loop of sea.json must be a positive number".into())?;
        must(!choppiness.number().is_nan(), || "choppiness of sea.json must be a number".into())?;
        let depth = document.get("depth");
        must(*depth == Json::Null || depth.number() > 0.0, || {
            "depth of sea.json must be null or a positive number".into()
        })?;
        let mut sea = Self {
            period: period.number(),
            choppiness: choppiness.number(),
            waves: Vec::new(),
            sizes: Vec::new(),
            neglected_rms: 0.0,
            document: document.clone(),
        };
        let depth = if *depth == Json::Null { f64::INFINITY } else { depth.number() };
        for index in 0..document.get("tiles").items().len() {
            sea.add_tile(index, depth, &read)?;
        }
        sea.waves.sort_by(|a, b| b.square().total_cmp(&a.square()));
        let lost: f64 = sea.waves.iter().skip(strongest).map(|wave| wave.square() / 2.0).sum();
        sea.neglected_rms = lost.sqrt();
        sea.waves.truncate(strongest);
        Ok(sea)
    }

    /// Water that rests at (x0, y0): it is at (x, y, height) now.
    pub fn rest(&self, x0: f64, y0: f64, t: f64) -> Water {
        self.water([x0, y0], x0, y0, t)
    }

    /// Water above (x, y), that is x0 + choppiness D(x0) = x, by Newton's method.
    pub fn at(&self, x: f64, y: f64, t: f64) -> Water {
        let mut found = self.water([x, y], x, y, t);
        let mut least = found.jacobian;
        for _ in 0..30 {
            if found.residual <= 1e-9 {
                break;
            }
            let (dx, dy) = (found.x - x, found.y - y);
            let [xx, xy, yy] = found.gradient;
            let j = found.jacobian.max(0.2); // short steps near a fold
            let x0 = found.x0 - (yy * dx - xy * dy) / j;
            found = self.water([x, y], x0, found.y0 - (xx * dy - xy * dx) / j, t);
            least = least.min(found.jacobian);
        }
        Water { jacobian: least, ..found }
    }

    fn water(&self, goal: [f64; 2], x0: f64, y0: f64, t: f64) -> Water {
        let (now, c) = (t % self.period / self.period, self.choppiness);
        // In each tile's own period: far from the origin no digits are lost.
        let places: Vec<[f64; 2]> = self
            .sizes
            .iter()
            .map(|size| [x0 % size[0] / size[0], y0 % size[1] / size[1]])
            .collect();
        let (mut height, mut moved, mut slope) = (0.0, [0.0; 2], [0.0; 2]);
        let mut stretch = [0.0; 3];
        for w in &self.waves {
            let place = places[w.tile];
            let turn =
                f64::from(w.mx) * place[0] + f64::from(w.my) * place[1] - f64::from(w.cycles) * now;
            let (sine, cosine) = (TAU * (turn - turn.round())).sin_cos();
            let (a, b) = (w.re * cosine - w.im * sine, w.re * sine + w.im * cosine);
            let (kx, ky, fa, fb) = (w.kx, w.ky, w.f * a, w.f * b);
            height += a;
            slope = [slope[0] - kx * b, slope[1] - ky * b];
            moved = [moved[0] - kx * fb, moved[1] - ky * fb];
            let [xx, xy, yy] = stretch;
            stretch = [xx - kx * kx * fa, xy - kx * ky * fa, yy - ky * ky * fa];
        }
        let [xx, xy, yy] = [1.0 + c * stretch[0], c * stretch[1], 1.0 + c * stretch[2]];
        let jacobian = xx * yy - xy * xy;
        let n = [xy * slope[1] - yy * slope[0], xy * slope[0] - xx * slope[1], jacobian];
        let length = n[0].hypot(n[1]).hypot(n[2]);
        let (x, y) = (x0 + c * moved[0], y0 + c * moved[1]);
        Water {
            x0,
            y0,
            x,
            y,
            height,
            normal: n.map(|part| part / length),
            residual: (x - goal[0]).hypot(y - goal[1]),
            jacobian,
            gradient: [xx, xy, yy],
        }
    }

    fn add_tile(
        &mut self,
        index: usize,
        depth: f64,
        read: &impl Fn(&str, usize) -> Option<Vec<u8>>,
    ) -> Result<(), String> {
        let tile = &self.document.get("tiles").items()[index];
        let name = format!("tile{index}.waves");
        let of = format!("of tile {index} in sea.json must");
        let (n, size) = (tile.get("n").items(), tile.get("size").items());
        must(n.len() == 2 && n.iter().all(|side| side.is_power(1024.0)), || {
            format!("n {of} be two powers of two from 2 to 1024")
        })?;
        must(size.len() == 2 && size.iter().all(|side| side.number() > 0.0), || {
            format!("size {of} be two positive numbers")
        })?;
        let (nx, ny) = (n[0].number() as i32, n[1].number() as i32);
        let (lx, ly) = (size[0].number(), size[1].number());
        let (count, fastest) = (tile.get("waves"), tile.get("most_cycles"));
        must(count.is_whole(0.0, f64::from(nx * ny)) && fastest.is_whole(0.0, 65535.0), || {
            format!("waves {of} fit its n and most_cycles")
        })?;
        let expected = 14 * count.number() as usize;
        let rows = self.document.get("files").items().iter();
        let digest = rows
            .filter(|row| row.get("name").text() == name)
            .find(|row| row.get("bytes").number() == expected as f64)
            .map_or("", |row| row.get("sha256").text());
        must(digest.len() == 64, || {
            format!("sea.json must list {name} with {expected} bytes and its SHA-256")
        })?;
        let bytes = read(&name, expected).ok_or(format!("{name} does not exist"))?;
        must(bytes.len() == expected, || {
            format!("{name} must have {expected} bytes, got {}", bytes.len())
        })?;
        must(sha256(&bytes) == digest, || format!("{name} was changed after it was written"))?;
        self.sizes.push([lx, ly]);
        let mut last = -1;
        for (i, r) in bytes.chunks(14).enumerate() {
            let word = |at: usize| u16::from_le_bytes([r[at], r[at + 1]]);
            let real = |at: usize| {
                2.0 * f64::from(f32::from_le_bytes([r[at], r[at + 1], r[at + 2], r[at + 3]]))
            };
            let (mx, my) = (i32::from(word(0) as i16), i32::from(word(2) as i16));
            let (kx, ky) = (TAU * f64::from(mx) / lx, TAU * f64::from(my) / ly);
            let (k, cycles) = (kx.hypot(ky), u32::from(word(4)));
            let f = 1.0 / (k * (k * depth).tanh());
            let (re, im) = (real(6), real(10));
            let wave = Wave { tile: index, mx, my, cycles, re, im, kx, ky, f };
            let place = my.rem_euclid(ny) * nx + mx.rem_euclid(nx);
            let record = |rule: String| format!("record {i} of {name} must {rule}");
            must(2 * mx.abs() < nx && 2 * my.abs() < ny && (mx, my) != (0, 0), || {
                record(format!("have |mx| < {} and |my| < {}, not both 0", nx / 2, ny / 2))
            })?;
            must(place > last, || record("follow the one before in the plane".into()))?;
            must(wave.square() > 0.0 && wave.square().is_finite(), || {
                record("have a finite amplitude, not 0".into())
            })?;
            must((1..=fastest.number() as u32).contains(&cycles), || {
                record(format!("have 1 to {} cycles", fastest.number()))
            })?;
            last = place;
            self.waves.push(wave);
        }
        Ok(())
    }
}

/// The document, checked: its checksum is that of all before the last key.
fn parsed(file: Option<Vec<u8>>) -> Result<Json, String> {
    let bytes = file.ok_or("sea.json does not exist")?;
    must(bytes.len() <= MOST, || format!("sea.json must have at most {MOST} bytes, got more"))?;
    let tree = Parser::parse(&bytes)?;
    let (format, version) = (tree.get("format").text(), tree.get("version").number());
    must(format == "fftocean-runtime", || {
        format!("format of sea.json must be fftocean-runtime, got {format}")
    })?;
    must(version == 1.0, || format!("version of sea.json must be 1, got {version}"))?;
    let check = tree.get("check").text();
    let end = format!(",\n  \"check\": \"{check}\"\n}}\n");
    let start = bytes.len().saturating_sub(end.len());
    let before = [&bytes[..start], b"\n}\n"].concat();
    must(bytes.ends_with(end.as_bytes()) && sha256(&before) == check, || {
        "sea.json was changed after it was written".into()
    })?;
    must(tree.get("ticks").is_power(1048576.0), || {
        "ticks of sea.json must be a power of two from 2 to 1048576".into()
    })?;
    must((1..=16).contains(&tree.get("tiles").items().len()), || {
        "tiles of sea.json must be a list of 1 to 16".into()
    })?;
    must(matches!(tree.get("files"), Json::List(_)), || "files of sea.json must be a list".into())?;
    Ok(tree)
}

fn must(right: bool, rule: impl FnOnce() -> String) -> Result<(), String> {
    if right {
        Ok(())
    } else {
        Err(rule())
    }
}

//! The waves of a package as the kernels take them: fftocean's docs/kernels.md has the bytes.
//! No Bevy in here: this file is compiled, run and compared with fftocean's own arrays.

use crate::sea_waves::{Json, SeaWaves};
use std::f64::consts::TAU;

/// Samples a side of a tile that the kernels transform: their numbers of a line take 16 KiB.
pub const MOST_SIDE: u32 = 512;
/// Bytes of the uniform block of the kernels: 96, and 64 for each of 16 tiles.
pub const BLOCK: usize = 96 + 64 * 16;

#[derive(Clone, Copy, Debug)]
pub struct Tile {
    pub nx: u32,
    pub ny: u32,
    pub first: u32,     // first texel in h0, wave and work
    pub first_map: u32, // first texel in maps
    pub size: [f64; 2], // [m]
    pub mixed: f32,
}

pub struct Layout {
    pub tiles: Vec<Tile>,
    pub h0: Vec<f32>, // four numbers a texel
    pub wave: Vec<f32>,
    pub twiddle: Vec<f32>,
    pub ticks: u32,
    pub texels: u32,
    pub map_texels: u32,
    pub groups: u32,    // of the kernels rows and columns, for each tile
    pub longest: u32,   // samples of the longest side
    pub foam: [f32; 3], // decay [s], threshold [-], strength [1/s]
}

impl Layout {
    pub fn new(sea: &SeaWaves) -> Result<Self, String> {
        let foam = sea.document.get("foam");
        let mut layout = Self {
            tiles: Vec::new(),
            h0: Vec::new(),
            wave: Vec::new(),
            twiddle: Vec::new(),
            ticks: sea.document.get("ticks").number() as u32,
            texels: 0,
            map_texels: 0,
            groups: 1,
            longest: 2,
            foam: ["decay", "threshold", "strength"].map(|key| foam.get(key).number() as f32),
        };
        for (index, one) in sea.document.get("tiles").items().iter().enumerate() {
            let n: Vec<u32> = one.get("n").items().iter().map(|n| n.number() as u32).collect();
            let (nx, ny) = (n[0], n[1]);
            if nx.max(ny) > MOST_SIDE {
                return Err(format!(
                    "n of tile {index} must be at most {MOST_SIDE} for the kernels"
                ));
            }
            layout.tiles.push(Tile {
                nx,
                ny,
                first: layout.texels,
                first_map: layout.map_texels,
                size: sea.sizes[index],
                mixed: one.get("mixed").number() as f32,
            });
            layout.texels += nx * ny;
            layout.map_texels += 3 * texels_of_levels(nx, ny);
            layout.groups = layout.groups.max(nx * ny / MOST_SIDE);
            layout.longest = layout.longest.max(nx).max(ny);
        }
        layout.fill(sea);
        for i in 0..layout.longest {
            let angle = TAU * f64::from(i) / f64::from(layout.longest);
            layout.twiddle.extend([angle.cos() as f32, angle.sin() as f32]);
        }
        Ok(layout)
    }

    /// Lay out 1 / (k tanh(k depth)) of every wavenumber; h0 at k, and its conjugate at -k.
    fn fill(&mut self, sea: &SeaWaves) {
        let depth = match sea.document.get("depth") {
            Json::Number(depth) => *depth,
            _ => f64::INFINITY,
        };
        self.h0 = vec![0.0; 4 * self.texels as usize];
        self.wave = vec![0.0; 2 * self.texels as usize];
        for tile in &self.tiles {
            for y in 0..tile.ny {
                for x in 0..tile.nx {
                    let kx = TAU * whole(x, tile.nx) / tile.size[0];
                    let ky = TAU * whole(y, tile.ny) / tile.size[1];
                    let k = kx.hypot(ky);
                    let at = (tile.first + y * tile.nx + x) as usize;
                    let factor = 1.0 / (k * (k * depth).tanh());
                    self.wave[2 * at + 1] = if k > 0.0 { factor as f32 } else { 0.0 };
                }
            }
        }
        for wave in &sea.waves {
            let tile = self.tiles[wave.tile];
            let (nx, ny) = (tile.nx as i32, tile.ny as i32);
            let texel = |mx: i32, my: i32| {
                tile.first as usize + (my.rem_euclid(ny) * nx + mx.rem_euclid(nx)) as usize
            };
            // SeaWaves has them doubled.
            let (re, im) = ((wave.re / 2.0) as f32, (wave.im / 2.0) as f32);
            let (at, opposite) = (texel(wave.mx, wave.my), texel(-wave.mx, -wave.my));
            self.h0[4 * at..4 * at + 2].copy_from_slice(&[re, im]);
            self.h0[4 * opposite + 2..4 * opposite + 4].copy_from_slice(&[re, -im]);
            self.wave[2 * at] = wave.cycles as f32;
            self.wave[2 * opposite] = wave.cycles as f32;
        }
    }

    /// The uniform block of the kernels at a moment, without a window of foam.
    pub fn block(&self, tick: u32, choppiness: f32) -> Vec<u8> {
        let mut block = vec![0; BLOCK];
        let mut put = |at: usize, bytes: [u8; 4]| block[at..at + 4].copy_from_slice(&bytes);
        let counts = [self.tiles.len() as u32, self.twiddle.len() as u32 / 2];
        for (i, value) in [tick, self.ticks - 1, counts[0], counts[1]].iter().enumerate() {
            put(4 * i, value.to_le_bytes());
        }
        put(16, (1.0 / self.ticks as f32).to_le_bytes());
        put(20, choppiness.to_le_bytes());
        for (i, value) in self.foam.iter().enumerate() {
            put(64 + 4 * i, value.to_le_bytes());
        }
        for (i, tile) in self.tiles.iter().enumerate() {
            let at = 96 + 64 * i;
            let counts = [tile.nx, tile.ny, tile.first, tile.first_map];
            for (j, value) in counts.iter().enumerate() {
                put(at + 4 * j, value.to_le_bytes());
            }
            let [lx, ly] = tile.size;
            let sides = [lx as f32, ly as f32, (TAU / lx) as f32, (TAU / ly) as f32];
            for (j, value) in sides.iter().chain(&[1.0, tile.mixed, 1.0, 1.0]).enumerate() {
                put(at + 16 + 4 * j, value.to_le_bytes());
            }
        }
        block
    }
}

/// Texels of all levels of a plane.
pub fn texels_of_levels(nx: u32, ny: u32) -> u32 {
    let next = if nx * ny > 1 { texels_of_levels((nx / 2).max(1), (ny / 2).max(1)) } else { 0 };
    nx * ny + next
}

fn whole(i: u32, n: u32) -> f64 {
    if 2 * i < n {
        f64::from(i)
    } else {
        f64::from(i) - f64::from(n)
    }
}

/// The bytes of some numbers, as a storage buffer takes them.
pub fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

// fftocean: one tile at any time, for `Ocean(..., backend="gpu")`; docs/gpu.md. Compiled behind fftocean.wgsl, whose phasors and
// transforms it takes.
//
// `advance` moves the waves of the half plane of wavenumbers. Two real fields A and B then share one complex transform, of A + i B:
// `begin`, `proceed` and `finish` transform it, a group of lines at a time. Lines longer than PLACES take two steps (Bailey 1990):
// with n = n1 n2, transforms of n1 samples n2 apart, a twist by e^(2 pi i j k / n), and transforms of n2 neighbours.

struct Moment {
  whole: vec2u,     // time in whole units, two's complement: low and high half
  part: vec2u,      // and 2^-64 units
  rate: u32,        // 1 for the time derivative of the height
  per_unit: f32,    // of a frequency in `pace` [rad/s]
  second_order: u32,// 1 if `bound` has waves
  choppiness: f32,
}

struct Patch { n: vec2u, columns: u32, unused: u32, dk: vec2f, unused_1: vec2u }

// The derivatives of each of two fields along x and y, and 1 if it is one of the potential; the factor on the second before the
// transform, and those on both after it; 1 if there is a second.
struct Pair { first: vec3u, second: vec3u, weight: f32, scales: vec2f, both: u32 }

// Transforms of one length: sample e of line l is at strides.x e + strides.y (l / inner) + strides.z (l % inner).
struct Stage {
  read: vec3u, length: u32,
  write: vec3u, lines: u32,
  inner: u32,
  twist: vec2u,     // turns of 1/twiddles for each line out and in, and sample
}

struct Piece { first: u32, count: u32, unused: vec2u }

@group(1) @binding(0) var<uniform> moment: Moment;
@group(1) @binding(1) var<uniform> tile: Patch;
@group(1) @binding(2) var<uniform> pair: Pair;
@group(1) @binding(3) var<uniform> stage: Stage;
@group(1) @binding(4) var<storage, read> waves: array<vec4f>;       // forward, backward; rows of `columns`
@group(1) @binding(5) var<storage, read> pace: array<vec4u>;        // frequency: whole, 2^-32, 2^-64; bits of 1/(k tanh(k depth))
@group(1) @binding(6) var<storage, read_write> water: array<vec2f>; // h(k) at the moment, or its rate
@group(1) @binding(7) var<storage, read> bound: array<vec2f>;       // of second order, added to the height
@group(1) @binding(8) var<storage, read> entering: array<vec2f>;
@group(1) @binding(9) var<storage, read_write> leaving: array<vec2f>;
@group(1) @binding(10) var<storage, read_write> first: array<f32>;
@group(1) @binding(11) var<storage, read_write> second: array<f32>;
@group(1) @binding(12) var<uniform> piece: Piece;
@group(1) @binding(13) var<storage, read> slope_x: array<f32>;
@group(1) @binding(14) var<storage, read> slope_y: array<f32>;
@group(1) @binding(15) var<storage, read> stretch_xx: array<f32>;
@group(1) @binding(16) var<storage, read> stretch_xy: array<f32>;
@group(1) @binding(17) var<storage, read> stretch_yy: array<f32>;
@group(1) @binding(18) var<storage, read_write> result: array<f32>;

// The upper half of a product.
fn upper(a: u32, b: u32) -> u32 {
  let a0 = a & 0xffffu; let a1 = a >> 16u;
  let b0 = b & 0xffffu; let b1 = b >> 16u;
  let middle = a1 * b0 + ((a0 * b0) >> 16u);
  let other = a0 * b1 + (middle & 0xffffu);
  return a1 * b1 + (middle >> 16u) + (other >> 16u);
}

// Cosine and sine of frequency times time, in whole numbers: exact to 2^-29 cycles at any time.
fn phasor_at(frequency: vec3u) -> vec2f {
  let turn = frequency.x * moment.part.y + upper(frequency.x, moment.part.x)
    + frequency.y * moment.whole.x + frequency.z * moment.whole.y + upper(frequency.z, moment.whole.x)
    + upper(frequency.y, moment.part.y);
  // Whole quarters apart: the rest is small, and loses nothing as a float.
  let quadrant = (turn + 0x20000000u) >> 30u;
  let e = phasor(f32(bitcast<i32>(turn - (quadrant << 30u))) * 2.3283064365386963e-10);
  let turned = select(vec2f(-e.y, e.x), e, (quadrant & 1u) == 0u);
  return select(-turned, turned, (quadrant & 2u) == 0u);
}

@compute @workgroup_size(256)
fn advance(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
  for (var i = id.x; i < tile.columns * tile.n.y; i += 256u * groups.x) {
    let frequency = pace[i].xyz;
    let e = phasor_at(frequency);
    let forward = times(waves[i].xy, vec2f(e.x, -e.y));
    let backward = times(waves[i].zw, e);
    let omega = (f32(frequency.x) + f32(frequency.y) * 2.3283064365386963e-10 + f32(frequency.z) * 5.421010862427522e-20)
      * moment.per_unit;
    water[i] = select(forward + backward, omega * times_i(backward - forward), moment.rate == 1u);
  }
}

fn derivative(orders: vec3u, k: vec2f, potential: f32, h: vec2f, weight: f32) -> vec2f {
  var factor = select(weight, weight * potential, orders.z == 1u);
  for (var i = 0u; i < orders.x; i++) { factor *= k.x; }
  for (var i = 0u; i < orders.y; i++) { factor *= k.y; }
  let value = factor * h;
  let quarters = orders.x + orders.y;
  let turned = select(times_i(value), value, (quarters & 1u) == 0u);
  return select(-turned, turned, (quarters & 2u) == 0u);
}

// The spectrum of A + i B at a texel of the whole plane, whose other half is the complex conjugate.
fn spectrum(at: u32) -> vec2f {
  let x = at % tile.n.x;
  let y = at / tile.n.x;
  if (2u * x == tile.n.x) { return vec2f(0.0); }
  let mirrored = 2u * x > tile.n.x;
  let texel = select(y * tile.columns + x, ((tile.n.y - y) & (tile.n.y - 1u)) * tile.columns + tile.n.x - x, mirrored);
  let conjugate = vec2f(1.0, select(1.0, -1.0, mirrored));
  let linear = conjugate * water[texel];
  var height = linear;
  if (moment.second_order == 1u) { height += conjugate * bound[texel]; }
  let potential = bitcast<f32>(pace[texel].w);
  let k = vec2f(whole(x, tile.n.x), whole(y, tile.n.y)) * tile.dk;
  let a = derivative(pair.first, k, potential, select(height, linear, pair.first.z == 1u), 1.0);
  let b = derivative(pair.second, k, potential, select(height, linear, pair.second.z == 1u), pair.weight);
  return a + times_i(b);
}

// Line and sample of an entry of a group: neighbours in memory for neighbouring threads.
fn entry(i: u32, along: bool) -> vec2u {
  let lines = PLACES / stage.length;
  return select(vec2u(i & (lines - 1u), i / lines), vec2u(i / stage.length, i & (stage.length - 1u)), along);
}

fn texel_of(strides: vec3u, line: u32, sample: u32) -> u32 {
  return strides.x * sample + strides.y * (line / stage.inner) + strides.z * (line % stage.inner);
}

fn twisted(value: vec2f, line: u32, sample: u32) -> vec2f {
  if (stage.twist.x + stage.twist.y == 0u) { return value; }
  let turns = (stage.twist.x * (line / stage.inner) + stage.twist.y * (line % stage.inner)) * sample;
  return times(twiddle[turns & (sea.twiddles - 1u)], value);
}

fn from_waves(line: u32, sample: u32) -> vec2f {
  if (line >= stage.lines) { return vec2f(0.0); }
  return spectrum(texel_of(stage.read, line, sample));
}

fn from_before(line: u32, sample: u32) -> vec2f {
  if (line >= stage.lines) { return vec2f(0.0); }
  return entering[texel_of(stage.read, line, sample)];
}

// The four complex numbers of a place in workgroup memory belong to four lines, PLACES / length apart.
fn take(t: u32, start: u32) {
  let lines = PLACES / stage.length;
  for (var i = t; i < PLACES; i += THREADS) {
    let e = entry(i, stage.read.x == 1u);
    let line = start + e.x;
    let place = e.y * lines + e.x;
    held[place] = vec4f(from_before(line, e.y), from_before(line + lines, e.y));
    held[PLACES + place] = vec4f(from_before(line + 2u * lines, e.y), from_before(line + 3u * lines, e.y));
  }
}

fn leave(line: u32, sample: u32, value: vec2f) {
  if (line < stage.lines) { leaving[texel_of(stage.write, line, sample)] = twisted(value, line, sample); }
}

fn hand_on(t: u32, start: u32) {
  let lines = PLACES / stage.length;
  for (var i = t; i < PLACES; i += THREADS) {
    let e = entry(i, stage.write.x == 1u);
    let line = start + e.x;
    let a = held[e.y * lines + e.x];
    let b = held[PLACES + e.y * lines + e.x];
    leave(line, e.y, a.xy);
    leave(line + lines, e.y, a.zw);
    leave(line + 2u * lines, e.y, b.xy);
    leave(line + 3u * lines, e.y, b.zw);
  }
}

fn write_fields(line: u32, sample: u32, value: vec2f) {
  if (line < stage.lines) {
    let at = texel_of(stage.write, line, sample);
    first[at] = pair.scales.x * value.x;
    if (pair.both == 1u) { second[at] = pair.scales.y * value.y; }
  }
}

@compute @workgroup_size(256)
fn begin(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) {
  let lines = PLACES / stage.length;
  let start = 4u * lines * group.x;
  for (var i = t; i < PLACES; i += THREADS) {
    let e = entry(i, stage.read.x == 1u);
    let line = start + e.x;
    let place = e.y * lines + e.x;
    held[place] = vec4f(from_waves(line, e.y), from_waves(line + lines, e.y));
    held[PLACES + place] = vec4f(from_waves(line + 2u * lines, e.y), from_waves(line + 3u * lines, e.y));
  }
  workgroupBarrier();
  transform(t, stage.length);
  hand_on(t, start);
}

@compute @workgroup_size(256)
fn proceed(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) {
  let start = 4u * (PLACES / stage.length) * group.x;
  take(t, start);
  workgroupBarrier();
  transform(t, stage.length);
  hand_on(t, start);
}

@compute @workgroup_size(256)
fn finish(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) {
  let lines = PLACES / stage.length;
  let start = 4u * lines * group.x;
  take(t, start);
  workgroupBarrier();
  transform(t, stage.length);
  for (var i = t; i < PLACES; i += THREADS) {
    let e = entry(i, stage.write.x == 1u);
    let line = start + e.x;
    let a = held[e.y * lines + e.x];
    let b = held[PLACES + e.y * lines + e.x];
    write_fields(line, e.y, a.xy);
    write_fields(line + lines, e.y, a.zw);
    write_fields(line + 2u * lines, e.y, b.xy);
    write_fields(line + 3u * lines, e.y, b.zw);
  }
}

// The unit normal along (1 + c Dxx, c Dxy, sx) x (c Dxy, 1 + c Dyy, sy); up where both tangents vanish.
@compute @workgroup_size(256)
fn normal(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
  for (var i = id.x; i < piece.count; i += 256u * groups.x) {
    let at = piece.first + i;
    let a = 1.0 + moment.choppiness * stretch_xx[at];
    let b = moment.choppiness * stretch_xy[at];
    let d = 1.0 + moment.choppiness * stretch_yy[at];
    let across = vec3f(b * slope_y[at] - slope_x[at] * d, b * slope_x[at] - slope_y[at] * a, a * d - b * b);
    let square = dot(across, across);
    let unit = select(vec3f(0.0, 0.0, 1.0), across / sqrt(square), square > 0.0);
    result[3u * i] = unit.x;
    result[3u * i + 1u] = unit.y;
    result[3u * i + 2u] = unit.z;
  }
}

// (1 + c Dxx)(1 + c Dyy) - (c Dxy)^2, the area of the displaced surface over that at rest.
@compute @workgroup_size(256)
fn jacobian(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
  for (var i = id.x; i < piece.count; i += 256u * groups.x) {
    let at = piece.first + i;
    let b = moment.choppiness * stretch_xy[at];
    result[i] = (1.0 + moment.choppiness * stretch_xx[at]) * (1.0 + moment.choppiness * stretch_yy[at]) - b * b;
  }
}

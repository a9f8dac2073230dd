// fftocean: the kernels of a sea at run time. docs/kernels.md has bindings, dispatch sizes and buffers.
//
// All tiles of a sea live in the same buffers, and one dispatch does all of them: `rows` and `columns` make a frame, `mips` and
// `mips_far` average it, `foam` moves on the foam of the sum of all tiles, `heights` finds the surface at points of the world, and
// `textures` copies maps to textures.
//
// No function takes a pointer to workgroup memory (naga refuses them), and nothing calls the built-in sin and cos, which are only good
// to 2^-11.

const MOST_TILES = 16;
const PLACES = 512u;   // samples that a workgroup transforms at once: 512 / n lines of n
const THREADS = 256u;  // half of them: a thread does one butterfly

struct Tile {
  nx: u32, ny: u32,    // powers of two, 2 to 512
  first: u32,          // first texel in h0, wave and work
  first_map: u32,      // first texel in maps
  size: vec2f,         // [m]
  dk: vec2f,           // 2 pi / size [rad/m]
  lifts: vec4f,        // powers of two for displace_y, stretch_xy, slope_y, stretch_yy; (1, mixed, 1, 1) will do
  origin: vec2f,       // place of the origin of foam and points, in sides of the tile, 0 to 1
  unused: vec2f,
}

struct Sea {
  tick: u32, mask: u32,                      // moment of the loop; ticks - 1
  tiles: u32, twiddles: u32,                 // counts
  turns_per_tick: f32, choppiness: f32,      // 1 / ticks
  points: u32, iterations: u32,              // of `heights`
  corner: vec2i, corner_before: vec2i,       // first cell of the window of foam, now and at the last step
  corner_place: vec2f,                       // of the middle of that cell, from the origin [m]
  cell: f32, seconds: f32,                   // side of a cell [m]; length of the step [s]
  decay: f32, threshold: f32, strength: f32, // of foam [s], [-], [1/s]
  foam_side: u32, foam_first: u32,           // cells a side, a power of two or 0; first texel in maps
  unused_0: u32, unused_1: u32, unused_2: u32,
  table: array<Tile, MOST_TILES>,
}

struct Target { plane: u32, level: u32, unused_0: u32, unused_1: u32 }

@group(0) @binding(0) var<uniform> sea: Sea;
@group(0) @binding(1) var<storage, read> h0: array<vec4f>;           // h0(k), conj(h0(-k)): tile<i>_h0.bin
@group(0) @binding(2) var<storage, read> wave: array<vec2f>;         // cycles in a loop, 1/(k tanh(k depth)): tile<i>_wave.bin
@group(0) @binding(3) var<storage, read> twiddle: array<vec2f>;      // cos, sin of 2 pi i / n: twiddle.bin
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;   // two a texel: four complex fields
@group(0) @binding(5) var<storage, read_write> maps: array<vec4f>;   // planes with all their levels
@group(0) @binding(6) var image: texture_storage_2d<rgba16float, write>;
@group(0) @binding(7) var<storage, read_write> answers: array<vec4f>;// two a point
@group(0) @binding(8) var<storage, read> places: array<vec2f>;       // of points, from the origin [m]
@group(0) @binding(9) var<uniform> target_level: Target;

var<workgroup> held: array<vec4f, 1024>;  // two halves of PLACES; also the averages of `mips`

fn times(a: vec2f, b: vec2f) -> vec2f { return vec2f(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

fn times_both(w: vec2f, v: vec4f) -> vec4f { return vec4f(times(w, v.xy), times(w, v.zw)); }

fn times_i(a: vec2f) -> vec2f { return vec2f(-a.y, a.x); }

// Cosine and sine of a phase in turns, 0 to 1, to 1e-7: polynomials within an eighth of a turn of the nearest quarter.
fn phasor(turn: f32) -> vec2f {
  let quarter = floor(4.0 * turn + 0.5);
  let x = turn - 0.25 * quarter;
  let q = x * x;
  let s = x * (6.2831853 + q * (-41.341663 + q * (81.591983 + q * -75.369649)));
  let c = 1.0 + q * (-19.739209 + q * (64.939363 + q * (-85.447456 + q * 59.362561)));
  let quadrant = u32(quarter);
  let turned = select(vec2f(-s, c), vec2f(c, s), (quadrant & 1u) == 0u);
  return select(-turned, turned, (quadrant & 2u) == 0u);
}

// The whole wavenumber of an entry of a transform.
fn whole(i: u32, n: u32) -> f32 { return select(f32(i) - f32(n), f32(i), 2u * i < n); }

// Inverse transforms, without 1/n, of the PLACES / n lines in workgroup memory: radix-2 Stockham steps. Sample i of line l is at
// i * (PLACES / n) + l, so that the inputs of thread t's butterfly are always at t and at t + THREADS.
fn transform(t: u32, n: u32) {
  let lines = PLACES / n;
  let l = t & (lines - 1u);
  let butterfly = t / lines;
  for (var part = 1u; part < n; part = 2u * part) {
    let r = butterfly & (part - 1u);
    let w = twiddle[r * (sea.twiddles / (2u * part))];
    let a = held[t];
    let b = held[PLACES + t];
    let c = times_both(w, held[THREADS + t]);
    let d = times_both(w, held[PLACES + THREADS + t]);
    workgroupBarrier();
    let to = (2u * butterfly - r) * lines + l;
    held[to] = a + c;
    held[PLACES + to] = b + d;
    held[to + part * lines] = a - c;
    held[PLACES + to + part * lines] = b - d;
    workgroupBarrier();
  }
}

// h(k) at the tick from h0(k), and the transforms along x. Workgroup (i, tile) has the texels from 512 i on: whole rows.
@compute @workgroup_size(256)
fn rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) {
  let nx = sea.table[group.y].nx;
  let ny = sea.table[group.y].ny;
  let start = PLACES * group.x;
  if (start >= nx * ny) { return; }
  let first = sea.table[group.y].first;
  let lifts = sea.table[group.y].lifts;
  let lines = PLACES / nx;
  for (var i = t; i < PLACES; i += THREADS) {
    let texel = start + i;
    if (texel >= nx * ny) { continue; }
    let x = texel & (nx - 1u);
    let amplitude = h0[first + texel];
    let cycles_and_factor = wave[first + texel];
    // Exact for ever: the product wraps at 2^32, and the ticks of a loop are a power of two.
    let turn = (u32(cycles_and_factor.x) * sea.tick) & sea.mask;
    let e = phasor(f32(turn) * sea.turns_per_tick);
    let height = times(amplitude.xy, vec2f(e.x, -e.y)) + times(amplitude.zw, e);
    let potential = height * cycles_and_factor.y;
    let k = vec2f(whole(x, nx), whole(texel / nx, ny)) * sea.table[group.y].dk;
    let displace_x = times_i(k.x * potential);
    let displace_y = times_i(k.y * potential);
    let slope_x = times_i(k.x * height);
    let slope_y = times_i(k.y * height);
    let stretch_xx = -k.x * k.x * potential;
    let stretch_xy = -k.x * k.y * potential;
    let stretch_yy = -k.y * k.y * potential;
    // Each part of a complex field comes out as a real one; a lift makes the second as large as the first.
    let place = x * lines + i / nx;
    held[place] = vec4f(displace_x + lifts.x * times_i(displace_y), height + lifts.y * times_i(stretch_xy));
    held[PLACES + place] = vec4f(slope_x + lifts.z * times_i(slope_y), stretch_xx + lifts.w * times_i(stretch_yy));
  }
  workgroupBarrier();
  transform(t, nx);
  for (var i = t; i < PLACES; i += THREADS) {
    let texel = start + i;
    if (texel >= nx * ny) { continue; }
    let place = (texel & (nx - 1u)) * lines + i / nx;
    work[2u * (first + texel)] = held[place];
    work[2u * (first + texel) + 1u] = held[PLACES + place];
  }
}

// The transforms along y, and the three maps. Workgroup (i, tile) has 512 / ny columns.
@compute @workgroup_size(256)
fn columns(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) {
  let nx = sea.table[group.y].nx;
  let ny = sea.table[group.y].ny;
  if (PLACES * group.x >= nx * ny) { return; }
  let first = sea.table[group.y].first;
  let lines = PLACES / ny;
  for (var i = t; i < PLACES; i += THREADS) {
    let x = group.x * lines + (i & (lines - 1u));
    if (x >= nx) { continue; }
    let at = 2u * (first + (i / lines) * nx + x);
    held[i] = work[at];
    held[PLACES + i] = work[at + 1u];
  }
  workgroupBarrier();
  transform(t, ny);
  // 1 / lift, to the bit: both are powers of two, and a division may be rounded.
  let lowered = bitcast<vec4f>(vec4u(254u << 23u) - bitcast<vec4u>(sea.table[group.y].lifts));
  let c = sea.choppiness;
  let plane = texels_of_levels(nx, ny);
  for (var i = t; i < PLACES; i += THREADS) {
    let x = group.x * lines + (i & (lines - 1u));
    if (x >= nx) { continue; }
    let a = held[i];
    let b = held[PLACES + i];
    let at = sea.table[group.y].first_map + (i / lines) * nx + x;
    let slope = vec2f(b.x, b.y * lowered.z);
    maps[at] = vec4f(c * a.x, c * a.y * lowered.x, a.z, c * a.w * lowered.y);
    maps[at + plane] = vec4f(slope, c * b.z, c * b.w * lowered.w);
    maps[at + 2u * plane] = vec4f(slope * slope, slope.x * slope.y, 0.0);
  }
}

// Texels of all levels of a plane.
fn texels_of_levels(nx: u32, ny: u32) -> u32 {
  var sum = 1u;
  for (var size = vec2u(nx, ny); size.x * size.y > 1u; size = max(size / 2u, vec2u(1u))) { sum += size.x * size.y; }
  return sum;
}

// Samples a side, and first texel, of a plane: three of each tile, then that of foam.
fn plane_at(index: u32) -> vec3u {
  if (index >= 3u * sea.tiles) { return vec3u(vec2u(sea.foam_side), sea.foam_first); }
  let tile = index / 3u;
  let nx = sea.table[tile].nx;
  let ny = sea.table[tile].ny;
  return vec3u(nx, ny, sea.table[tile].first_map + (index % 3u) * texels_of_levels(nx, ny));
}

// Samples a side, and first texel, of the next level.
fn next_level(plane: vec3u) -> vec3u { return vec3u(max(plane.xy / 2u, vec2u(1u)), plane.z + plane.x * plane.y); }

// Five levels from one: workgroup (i, j, plane) has a block of 32 x 32 texels.
fn average(group: vec3u, t: u32, base: u32) {
  var below = plane_at(group.z);
  for (var i = 0u; i < base; i++) {
    if (below.x * below.y == 1u) { return; }
    below = next_level(below);
  }
  if (any(32u * group.xy >= below.xy)) { return; }
  for (var side = 16u; side > 0u; side = side / 2u) {
    if (below.x * below.y <= 1u) { return; }
    let level = next_level(below);
    let own = vec2u(t % side, t / side);  // in the block
    let busy = own.y < side && all(side * group.xy + own < level.xy);
    let near = 2u * own;
    let far = min(near + 1u, min(vec2u(2u * side), below.xy) - 1u);
    var sum = vec4f(0.0);
    if (busy) {
      if (side == 16u) {
        let at = below.z + 32u * (group.y * below.x + group.x);
        sum = maps[at + near.y * below.x + near.x] + maps[at + near.y * below.x + far.x]
          + (maps[at + far.y * below.x + near.x] + maps[at + far.y * below.x + far.x]);
      } else {
        sum = held[16u * near.y + near.x] + held[16u * near.y + far.x]
          + (held[16u * far.y + near.x] + held[16u * far.y + far.x]);
      }
    }
    workgroupBarrier();
    if (busy) {
      held[16u * own.y + own.x] = 0.25 * sum;
      maps[level.z + (side * group.y + own.y) * level.x + side * group.x + own.x] = 0.25 * sum;
    }
    workgroupBarrier();
    below = level;
  }
}

// Levels 1 to 5 of every plane, from level 0.
@compute @workgroup_size(256)
fn mips(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) { average(group, t, 0u); }

// Levels 6 to 10, from level 5.
@compute @workgroup_size(256)
fn mips_far(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) t: u32) { average(group, t, 5u); }

// One level of a plane to a texture of its size.
@compute @workgroup_size(8, 8)
fn textures(@builtin(global_invocation_id) id: vec3u) {
  var level = plane_at(target_level.plane);
  for (var i = 0u; i < target_level.level; i++) { level = next_level(level); }
  if (any(id.xy >= level.xy)) { return; }
  textureStore(image, vec2i(id.xy), maps[level.z + id.y * level.x + id.x]);
}

// One step of foam at rest positions: df/dt = -f / decay + strength max(threshold - lambda, 0), lambda the smallest eigenvalue of the
// deformation gradient of the SUM of all tiles (Tessendorf 2001). Between the two ends of the step lambda is linear in time.
// A cell takes the nearest texel of each tile, neither filtered nor interpolated.
@compute @workgroup_size(8, 8)
fn foam(@builtin(global_invocation_id) id: vec3u) {
  let side = sea.foam_side;
  if (any(id.xy >= vec2u(side))) { return; }
  // A cell of the world keeps its place while the window moves over it.
  let cell = (vec2i(id.xy) - sea.corner) & vec2i(i32(side) - 1);
  let rest = sea.corner_place + sea.cell * vec2f(cell);
  var stretch = vec3f(0.0);
  for (var i = 0u; i < sea.tiles; i++) {
    let n = vec2u(sea.table[i].nx, sea.table[i].ny);
    let nearest = vec2u(floor(fract(rest / sea.table[i].size + sea.table[i].origin) * vec2f(n) + 0.5)) & (n - 1u);
    let at = sea.table[i].first_map + nearest.y * n.x + nearest.x;
    stretch += vec3f(maps[at + texels_of_levels(n.x, n.y)].zw, maps[at].w);
  }
  let middle = 1.0 + 0.5 * (stretch.x + stretch.y);
  let half_difference = 0.5 * (stretch.x - stretch.y);
  let now = sea.threshold - (middle - sqrt(half_difference * half_difference + stretch.z * stretch.z));
  let at = sea.foam_first + id.y * side + id.x;
  let before = maps[at].z;
  let d = exp(-0.25 * sea.seconds / sea.decay);  // what is left after a quarter of the step
  let made = 0.5 * d * d * d * d * max(before, 0.0) + d * d * d * max(mix(before, now, 0.25), 0.0)
    + d * d * max(mix(before, now, 0.5), 0.0) + d * max(mix(before, now, 0.75), 0.0) + 0.5 * max(now, 0.0);
  var amount = d * d * d * d * maps[at].y + 0.25 * sea.seconds * sea.strength * made;
  let old = sea.corner + cell - sea.corner_before;
  // A cell that enters the window has what a steady source would have left on it.
  if (any(old < vec2i(0)) || any(old >= vec2i(i32(side)))) { amount = sea.decay * sea.strength * max(now, 0.0); }
  maps[at] = vec4f(1.0 - exp(-amount), amount, now, 0.0);
}

struct Water { moved: vec2f, height: f32, slope: vec2f, stretch: vec3f }

// The sum of all tiles at a rest position. Height and displacement are cubic between the samples, from their values and gradients there
// (Adini's element); gradients are bilinear.
fn water_at(rest: vec2f) -> Water {
  var water = Water(vec2f(0.0), 0.0, vec2f(0.0), vec3f(0.0));
  for (var i = 0u; i < sea.tiles; i++) {
    let n = vec2u(sea.table[i].nx, sea.table[i].ny);
    let place = fract(rest / sea.table[i].size + sea.table[i].origin) * vec2f(n);
    let spacing = sea.table[i].size / vec2f(n);
    let plane = texels_of_levels(n.x, n.y);
    for (var corner = 0u; corner < 4u; corner++) {
      let side = vec2u(corner & 1u, corner >> 1u);
      let p = abs(place - floor(place) - vec2f(side));  // from the corner, 0 to 1
      let rest_of = 1.0 - p;
      let bilinear = rest_of.x * rest_of.y;
      let value = bilinear * (1.0 + p.x + p.y - 2.0 * dot(p, p));
      let gradient = bilinear * p * rest_of * spacing * (1.0 - 2.0 * vec2f(side));
      let texel = (vec2u(floor(place)) + side) & (n - 1u);
      let at = sea.table[i].first_map + texel.y * n.x + texel.x;
      let a = maps[at];
      let b = maps[at + plane];
      water.moved += value * a.xy + vec2f(dot(gradient, vec2f(b.z, a.w)), dot(gradient, vec2f(a.w, b.w)));
      water.height += value * a.z + dot(gradient, b.xy);
      water.slope += bilinear * b.xy;
      water.stretch += bilinear * vec3f(b.zw, a.w);
    }
  }
  return water;
}

fn jacobian_of(water: Water) -> f32 {
  return (1.0 + water.stretch.x) * (1.0 + water.stretch.y) - water.stretch.z * water.stretch.z;
}

// The displaced surface above points of the world, by Newton's iteration on the rest position.
@compute @workgroup_size(64)
fn heights(@builtin(global_invocation_id) id: vec3u) {
  if (id.x >= sea.points) { return; }
  let goal = places[id.x];
  var rest = goal;
  var water = water_at(rest);
  for (var i = 0u; i < sea.iterations; i++) {
    let apart = rest + water.moved - goal;
    let determinant = max(jacobian_of(water), 0.2);  // short steps near a fold
    let s = water.stretch;
    rest -= vec2f((1.0 + s.y) * apart.x - s.z * apart.y, (1.0 + s.x) * apart.y - s.z * apart.x) / determinant;
    water = water_at(rest);
  }
  let s = water.stretch;
  let normal = vec3f(s.z * water.slope.y - (1.0 + s.y) * water.slope.x, s.z * water.slope.x - (1.0 + s.x) * water.slope.y,
    jacobian_of(water));
  answers[2u * id.x] = vec4f(rest, water.height, length(rest + water.moved - goal));
  answers[2u * id.x + 1u] = vec4f(normal / max(length(normal), 1e-20), jacobian_of(water));
}

// Shaders of the water: the mesh, and the light of its surface.
import { FRAGMENT_HEAD, VERTEX_HEAD } from './heads.js';
import { SKY_LOOKUP } from './air.js';
import { FOAM_LOOKUP } from './breaking.js';
import { displacementSum, rippleSum, slopeSum, tilePlaces } from './tiles.js';
import { HIGHEST, LOWEST } from '../visible_slopes.js';

/** The height of the eye, lifted out of the crests that pass it. */
export const LIFTED_EYE = `
uniform sampler2D floating; // heights of the surface where something floats; the eye is the first
uniform float eye_height;

float lifted_eye() {
  return max(eye_height, texelFetch(floating, ivec2(0), 0).z + 0.45);
}
`;

/**
 * Return the source of the mesh's vertex shader.
 *
 * The mesh is a sector of rings and columns about an apex behind the eye, made of the numbers of
 * its vertices: a strip of triangles for each pair of rings, the nearest first.
 */
export function meshVertex(count) {
  return `${VERTEX_HEAD}${tilePlaces(count)}${displacementSum(count)}${slopeSum(count, { spaced: true })}${LIFTED_EYE}
uniform mat4 view_projection;
uniform sampler2D rings; // distance from the eye, and gap to the next
uniform vec4 sector; // distance of the apex behind the eye, direction and half angle, columns
uniform vec3 beyond; // slope variance of the waves that no tile holds
out vec3 place; // from the eye, displaced
out vec2 rest; // from the eye, at rest
out vec2 mesh_slope;
out vec3 mesh_variance; // of the slopes that the mesh does not hold
out vec2 cell;

const float EARTH = 6371e3;

void main() {
  int ring = gl_InstanceID + (gl_VertexID & 1), column = gl_VertexID >> 1;
  vec2 found = texelFetch(rings, ivec2(ring, 0), 0).xy;
  float angle = sector.y + sector.z * (2.0 * float(column) / sector.w - 1.0);
  float from_apex = found.x + sector.x;
  rest = from_apex * vec2(cos(angle), sin(angle)) - sector.x * vec2(cos(sector.y), sin(sector.y));
  // Waves shorter than the mesh can hold are left to the shading. A vertex stands for something
  // between its gaps along and across: near the horizon the first is far longer than the second.
  float across = from_apex * 2.0 * sector.z / sector.w;
  float spacing = pow(max(across, 1e-3), 0.4) * pow(found.y, 0.6);
  float distance_ = length(rest);
  float eye = lifted_eye();
  place = vec3(rest, -eye - distance_ * distance_ / (2.0 * EARTH)) + displaced(rest, spacing);
  Sums sums = summed(rest, 2.0 * spacing);
  mesh_slope = sums.slope;
  mesh_variance = sums.variance + beyond;
  cell = vec2(float(column), float(ring));
  gl_Position = view_projection * vec4(place, 1.0);
}`;
}

/** Statistics of the slopes that an eye sees; see visible_slopes.js. */
export const VISIBLE_SLOPES = `
uniform sampler2D visible_rules; // nodes less x, and weights, by x

// E[max(y, 0)] of a y that is distributed normally.
float mean_above_zero(float mean, float deviation) {
  if (mean > 6.0 * deviation) return mean;
  float x = max(mean / deviation, -3.0);
  float density = 0.39894228 * exp(-0.5 * x * x);
  // Abramowitz & Stegun 26.2.17
  float t = 1.0 / (1.0 + 0.2316419 * abs(x));
  float tail = density * t * (0.31938153 + t * (-0.356563782 + t * (1.781477937 +
    t * (-1.821255978 + t * 1.330274429))));
  return deviation * (density + x * (x > 0.0 ? 1.0 - tail : tail));
}

// Projected areas of four facets that stand for all that are seen, and their weights.
void visible_facets(float mean, float deviation, out vec4 areas, out vec4 weights) {
  float x = mean / deviation, last = float(textureSize(visible_rules, 0).x) - 1.0;
  float at = clamp((x - ${LOWEST.toFixed(1)}) / ${(HIGHEST - LOWEST).toFixed(1)}, 0.0, 1.0);
  float place = (at * last + 0.5) / (last + 1.0);
  areas = max(x, ${LOWEST.toFixed(1)}) + textureLod(visible_rules, vec2(place, 0.25), 0.0);
  areas *= deviation;
  weights = textureLod(visible_rules, vec2(place, 0.75), 0.0);
}

float variance_along(vec3 variance, vec2 direction) {
  vec2 square = direction * direction;
  return dot(variance, vec3(square, 2.0 * direction.x * direction.y));
}

// Smith's shadowing of a rough sea, as Bruneton, Neyret & Holzschuch (2010) write it.
float shadowing(float cosine, float variance) {
  float cotangent = cosine / sqrt(max(1.0 - cosine * cosine, 1e-6) * 2.0 * variance);
  float gauss = exp(-cotangent * cotangent);
  float erfc = 2.0 * gauss / (2.319 * cotangent + sqrt(4.0 + 1.52 * cotangent * cotangent));
  return max((gauss - 1.7724539 * cotangent * erfc) / (3.5449077 * cotangent), 0.0);
}

// Unpolarised light on water, index 1.34 (Born & Wolf).
float fresnel(float cosine) {
  float c = clamp(cosine, 0.0, 1.0), g = sqrt(0.7956 + c * c);
  float first = (g - c) / (g + c), second = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
  return 0.5 * first * first * (1.0 + second * second);
}
`;

/** Slopes of the displaced surface at a pixel. */
export const SURFACE = `
struct Surface {
  vec2 slope;
  vec3 variance;
  float jacobian;
};

/*
 * Slope of the displaced surface (closed form of the eight linear fields), and the covariance that
 * filtering left, taken through the same linear map.
 */
Surface displaced_surface(Sums sums, vec3 beyond) {
  float a = 1.0 + sums.stretch.x, b = 1.0 + sums.stretch.y, c = sums.stretch.z;
  float jacobian = max(a * b - c * c, 0.15);
  vec2 slope = vec2(b * sums.slope.x - c * sums.slope.y, a * sums.slope.y - c * sums.slope.x) / jacobian;
  slope *= min(1.0, 2.2 / max(length(slope), 1e-4));
  vec3 variance = max(sums.variance + beyond, vec3(2e-5, 2e-5, -1.0));
  // A covariance cannot exceed what the variances allow; filtering of half floats may say so.
  float most = 0.98 * sqrt(variance.x * variance.y);
  variance.z = clamp(variance.z, -most, most);
  return Surface(slope, variance, a * b - c * c);
}
`;

export const INPUTS = `
uniform vec3 beyond;
in vec3 place;
in vec2 rest;
in vec2 mesh_slope;
in vec3 mesh_variance;
in vec2 cell;
out vec4 colour;
`;

/** Return the source of the fragment shader that lights the water. */
export function waterShader(count, tone) {
  return `${FRAGMENT_HEAD}${SKY_LOOKUP}${tone}${tilePlaces(count)}${slopeSum(count)}
uniform vec3 ripple_frame; // place of the eye in the ripples, and 1 / size of their tile
${rippleSum(count)}${VISIBLE_SLOPES}${SURFACE}${FOAM_LOOKUP}${LIFTED_EYE}${INPUTS}
uniform sampler2D sky, light;
uniform vec3 sunward, absorption, backscattering, reflectance;
uniform float wave_height, air_extinction, crest_light;

const float PI = 3.14159265;

// What a facet mirrors of the sky, blurred over an angle; share is what it mirrors of anything.
vec3 mirrored(vec3 to_eye, vec2 slope, float across, float blur, out float share) {
  vec3 normal = vec3(-slope, 1.0) * inversesqrt(1.0 + dot(slope, slope) + across);
  float cosine = max(dot(normal, to_eye), 0.001);
  share = fresnel(cosine);
  vec3 ray = 2.0 * cosine * normal - to_eye;
  float up = ray.z;
  // A ray that hardly rises, or goes down, may meet another wave, which shows a darker sky.
  ray = normalize(vec3(ray.xy, sqrt(up * up + 0.0025)));
  float level = log2(max(1.1 * blur * float(textureSize(sky, 0).x), 1.0));
  vec3 radiance = textureLod(sky, sky_place(ray), min(level, 6.0)).rgb;
  return share * radiance * mix(1.0, 0.5, smoothstep(0.15, -0.3, up));
}

void main() {
  float distance_ = length(place);
  vec3 to_eye = -place / distance_;
  Sums sums = summed(rest);
  vec3 unseen = beyond;
  add_ripples(rest, sums, unseen);
  Surface surface = displaced_surface(sums, unseen);

  // Along and across the line of sight.
  float level_part = max(length(to_eye.xy), 1e-4);
  vec2 ahead = to_eye.xy / level_part, aside = vec2(-ahead.y, ahead.x);
  float slope_along = dot(surface.slope, ahead), slope_across = dot(surface.slope, aside);
  float along = max(variance_along(surface.variance, ahead), 1e-6);
  float across = max(variance_along(surface.variance, aside), 1e-6);
  float deviation = sqrt(along), projected_deviation = deviation * level_part;

  /*
   * What this pixel shows of its facets, over what the mesh lets it show: the mesh holds the long
   * waves, and of the others each pixel shows a sample. Dividing by the area that all of them would
   * show, whatever the pixel's size, makes pictures of any size average to the same.
   */
  float middle = to_eye.z - slope_along * level_part;
  float area = mean_above_zero(middle, projected_deviation);
  float mesh_deviation = level_part * sqrt(max(variance_along(mesh_variance, ahead), 1e-6));
  float mesh_middle = to_eye.z - dot(mesh_slope, ahead) * level_part;
  float mesh_area = max(mean_above_zero(mesh_middle, mesh_deviation), 0.01);
  float weight = clamp(area / mesh_area, 0.2, 3.0);

  vec4 areas, weights, shares;
  visible_facets(middle, projected_deviation, areas, weights);
  vec4 facets = slope_along + (middle - areas) / level_part; // their slopes along the line of sight
  vec2 turned = aside * slope_across;
  float blur = 0.2 * deviation + 0.8 * to_eye.z * sqrt(across);
  vec3 reflected = weights.x * mirrored(to_eye, ahead * facets.x + turned, across, blur, shares.x);
  reflected += weights.y * mirrored(to_eye, ahead * facets.y + turned, across, blur, shares.y);
  reflected += weights.z * mirrored(to_eye, ahead * facets.z + turned, across, blur, shares.z);
  reflected += weights.w * mirrored(to_eye, ahead * facets.w + turned, across, blur, shares.w);
  float share = dot(weights, shares);

  // A facet mirrors the sun where its slope is that of the half vector (Cox & Munk 1954).
  vec3 sun_light = texelFetch(light, ivec2(0), 0).rgb, sky_light = texelFetch(light, ivec2(1, 0), 0).rgb;
  vec3 glitter = vec3(0.0);
  vec3 halfway = normalize(sunward + to_eye);
  if (halfway.z > 0.02 && sunward.z > -0.01) {
    vec3 variance = surface.variance + vec3(5.4e-6, 5.4e-6, 0.0); // the sun is a disc
    float determinant = variance.x * variance.y - variance.z * variance.z;
    vec2 off = -halfway.xy / halfway.z - surface.slope;
    float square = (variance.y * off.x * off.x - 2.0 * variance.z * off.x * off.y +
      variance.x * off.y * off.y) / determinant;
    float probability = exp(-0.5 * square) / (2.0 * PI * sqrt(determinant));
    float upright = halfway.z * halfway.z;
    float sun_variance = variance_along(mesh_variance, normalize(sunward.xy + 1e-5));
    float lit = 1.0 / (1.0 + shadowing(max(sunward.z, 0.005), sun_variance));
    glitter = sun_light * fresnel(dot(to_eye, halfway)) * probability * lit /
      (4.0 * upright * upright * mesh_area);
  }

  // Light from below.
  vec3 falling = sun_light * max(sunward.z, 0.0) + sky_light;
  vec3 body = reflectance * falling;
  vec3 facet = normalize(vec3(-surface.slope, 1.0));
  float crest = clamp(0.5 + (place.z + lifted_eye()) / wave_height, 0.0, 1.4);
  if (crest_light > 0.0) {
    // Taste, after Atlas (GDC 2019): sunlight that came through a crest, green by its way there.
    vec2 glare = normalize(sunward.xy + 1e-5);
    float against = pow(max(-dot(glare, ahead), 0.0) * 0.92 + 0.08, 3.0) * (1.0 - 0.7 * to_eye.z);
    float tilt = clamp(0.55 - 0.5 * dot(facet, sunward) + 0.4 * length(surface.slope), 0.0, 1.0);
    float way = mix(10.0, 2.2, clamp(crest, 0.0, 1.0));
    vec3 through = exp(-(absorption + backscattering) * way) * backscattering / (backscattering + 0.02);
    float steep = smoothstep(0.05, 0.5, length(surface.slope));
    body += crest_light * (sun_light * against * (0.3 + 0.7 * steep) + 0.15 * sky_light) * through * tilt * tilt * crest * 0.3;
  }

  vec3 radiance = weight * (reflected + (1.0 - share) * body) + glitter;

  // Foam: white patches, and the bubbles below them that make the water pale.
  vec3 foam = foam_at(rest);
  // A low sun, which is red, hardly reaches them; part of its colour is taken away, as the eye does
  // of what it knows to be white: taste, lest they look brown.
  float sunlit = smoothstep(-0.02, 0.06, sunward.z) * max(dot(facet, sunward) + 0.03, 0.0) / 1.03;
  vec3 paler = mix(sun_light, vec3(dot(sun_light, vec3(0.2126, 0.7152, 0.0722))), 0.4);
  vec3 white = 0.55 / PI * foam.z * (paler * sunlit + sky_light);
  vec3 bubbles = body + 0.12 / PI * falling * exp(-(absorption + backscattering) * 5.0);
  radiance = mix(radiance, mix(radiance, bubbles, 0.75), smoothstep(0.0, 0.6, foam.x) * (1.0 - share) * 0.8);
  radiance = mix(radiance, white, foam.y * 0.9);

  // Air between: what it takes away it replaces by the sky just above the horizon.
  vec3 haze_light = textureLod(sky, sky_place(normalize(vec3(-to_eye.xy, 0.02))), 1.0).rgb;
  radiance = mix(radiance, haze_light, 1.0 - exp(-distance_ * air_extinction));
  colour = shown(radiance, texelFetch(light, ivec2(3, 0), 0).x);
}`;
}

/**
 * Return the source of the shader that finds the surface where things float: texel 0 the eye,
 * texel 1 the buoy.
 *
 * The place at rest whose water is now there is found by iteration; the surface is the sum of the
 * tiles, as the mesh has it nearby.
 */
export function floatingShader(count) {
  return `${FRAGMENT_HEAD}${tilePlaces(count)}${displacementSum(count)}${slopeSum(count, { spaced: true })}
uniform vec2 places[2]; // from the eye [m]
uniform float spacings[2]; // size of what floats: it does not feel shorter waves
layout(location = 0) out vec4 position;
layout(location = 1) out vec4 tilt;

void main() {
  int which = int(gl_FragCoord.x);
  vec2 wanted = places[which], rest = wanted;
  float spacing = spacings[which];
  vec3 moved = vec3(0.0);
  for (int i = 0; i < 6; i++) {
    moved = displaced(rest, spacing);
    rest += 0.8 * (wanted - rest - moved.xy);
  }
  position = vec4(rest + moved.xy, moved.z, 1.0);
  tilt = vec4(summed(rest, spacing).slope, 0.0, 1.0);
}`;
}

// Colour of sea water: what it absorbs and what it sends back, by the chlorophyll in it.

/** Wavelengths of the red, green and blue channel [nm]. */
export const WAVELENGTHS = [610, 550, 465];

// Pure water at these wavelengths: absorption (Pope & Fry 1997, table 3) [1/m]; scattering of pure
// sea water (Smith & Baker 1981), half of it backward.
const WATER_ABSORPTION = [0.2644, 0.0565, 0.01006];
const SCATTERING_AT_500 = 0.00288;
const SCATTERING_SLOPE = -4.32;

// Absorption of chlorophyll relative to that at 440 nm (Prieur & Sathyendranath 1981, every 10 nm;
// the last is between 0.917 at 460 nm and 0.870 at 470 nm).
const CHLOROPHYLL_ABSORPTION = [0.252, 0.357, 0.8935];

/**
 * Return absorption and backscattering of sea water [1/m], each by channel.
 *
 * The bio-optical model of case 1 waters: absorption after Morel (1991), scattering of particles
 * after Gordon & Morel (1983), its backward share after Morel (1988, as Morel & Maritorena 2001
 * print it).
 *
 * @param {number} chlorophyll [mg/m^3], 0.03 in the clearest ocean to 10 on a green coast
 */
export function waterOptics(chlorophyll) {
  if (!(chlorophyll > 0)) {
    throw new RangeError(`chlorophyll must be positive, got ${chlorophyll} mg/m^3`);
  }
  const particles = 0.3 * chlorophyll ** 0.62;
  const absorption = WAVELENGTHS.map((wavelength, i) => {
    const living = WATER_ABSORPTION[i] + 0.06 * CHLOROPHYLL_ABSORPTION[i] * chlorophyll ** 0.65;
    return living * (1 + 0.2 * Math.exp(-0.014 * (wavelength - 440))); // and dissolved yellow matter
  });
  const backscattering = WAVELENGTHS.map((wavelength) => {
    const water = 0.5 * SCATTERING_AT_500 * (wavelength / 500) ** SCATTERING_SLOPE;
    const share = 0.002 + (0.02 * (0.5 - 0.25 * Math.log10(chlorophyll)) * 550) / wavelength;
    return water + particles * share;
  });
  return { absorption, backscattering };
}

/**
 * Return the remote-sensing reflectance [1/sr]: radiance that leaves the water over the irradiance
 * that falls on it.
 *
 * Below the surface after Gordon et al. (1988), through it after Lee, Carder & Arnone (2002).
 */
export function reflectance({ absorption, backscattering }) {
  return absorption.map((a, i) => {
    const share = backscattering[i] / (a + backscattering[i]);
    const below = (0.0949 + 0.0794 * share) * share;
    return (0.52 * below) / (1 - 1.7 * below);
  });
}

/**
 * Return the slope variance of a clean sea by Cox & Munk (1954), [xx, yy, xy].
 *
 * @param {number} speed of the wind [m/s]
 * @param {number} direction toward which it blows, counter-clockwise from east [degrees]
 */
export function coxMunk(speed, direction) {
  const upwind = 0.00316 * speed;
  const crosswind = 0.003 + 0.00192 * speed;
  const angle = (direction * Math.PI) / 180;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [
    upwind * c * c + crosswind * s * s,
    upwind * s * s + crosswind * c * c,
    (upwind - crosswind) * c * s,
  ];
}

/** Return Fresnel's reflectance of unpolarised light on still water, by the cosine of incidence. */
export function fresnel(cosine, index = 1.34) {
  const c = Math.min(Math.max(cosine, 0), 1);
  const g = Math.sqrt(index * index - 1 + c * c);
  const first = (g - c) / (g + c);
  const second = (c * (g + c) - 1) / (c * (g - c) + 1);
  return 0.5 * first * first * (1 + second * second);
}

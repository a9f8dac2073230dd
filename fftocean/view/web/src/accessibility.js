// The sea in words, for those who cannot see it.

/** Upper ends of the Beaufort numbers 0 to 11 [m/s] (WMO-No. 306, code table 1100). */
const BEAUFORT_ENDS = [0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7];

const BEAUFORT_NAMES = [
  'calm',
  'light air',
  'light breeze',
  'gentle breeze',
  'moderate breeze',
  'fresh breeze',
  'strong breeze',
  'near gale',
  'gale',
  'strong gale',
  'storm',
  'violent storm',
  'hurricane',
];

/** Upper ends of the significant wave height of sea states 0 to 8 [m] (WMO code table 3700). */
const SEA_STATE_ENDS = [0, 0.1, 0.5, 1.25, 2.5, 4, 6, 9, 14];

const SEA_STATE_NAMES = [
  'glassy',
  'rippled',
  'smooth',
  'slight',
  'moderate',
  'rough',
  'very rough',
  'high',
  'very high',
  'phenomenal',
];

const COMPASS = [
  'east',
  'east-north-east',
  'north-east',
  'north-north-east',
  'north',
  'north-north-west',
  'north-west',
  'west-north-west',
  'west',
  'west-south-west',
  'south-west',
  'south-south-west',
  'south',
  'south-south-east',
  'south-east',
  'east-south-east',
];

/** Return {number, name} of a wind speed [m/s] on the Beaufort scale. */
export function beaufort(speed) {
  const number = BEAUFORT_ENDS.filter((end) => speed >= end).length;
  return { number, name: BEAUFORT_NAMES[number] };
}

/** Return {number, name} of a significant wave height [m] on the scale of sea states. */
export function seaState(height) {
  const number = SEA_STATE_ENDS.filter((end) => height > end).length;
  return { number, name: SEA_STATE_NAMES[number] };
}

/** Return the compass name of a direction in degrees counter-clockwise from east. */
export function compassName(degrees) {
  const place = Math.round(degrees / 22.5);
  return COMPASS[((place % 16) + 16) % 16];
}

/** Return a number with two significant digits, or without decimals from 10. */
function short(value) {
  return String(Number(value < 10 ? value.toPrecision(2) : value.toFixed(0)));
}

/** Return a number with its unit, which is in the singular after 1. */
function amount(value, unit) {
  const text = short(value);
  return `${text} ${unit}${text === '1' ? '' : 's'}`;
}

/** Return true for a number that can be said. */
function known(value) {
  return typeof value === 'number' && Number.isFinite(value);
}

/** Return the clause that says how the waves are. */
function waves(statistics) {
  const { hs, tp, direction } = statistics;
  if (!known(hs)) return 'A sea.';
  if (hs < 0.005) return 'A flat sea without waves.';
  const parts = [`A ${seaState(hs).name} sea`, `significant wave height ${amount(hs, 'metre')}`];
  if (known(tp)) parts.push(`peak period ${amount(tp, 'second')}`);
  if (known(direction)) parts.push(`running toward the ${compassName(direction)}`);
  return `${parts.join(', ')}.`;
}

/** Return the clause of the wind, or an empty text. */
function wind(values) {
  const speed = values?.speed;
  if (!known(speed)) return '';
  const { number, name } = beaufort(speed);
  const toward = known(values.direction) ? ` toward the ${compassName(values.direction)}` : '';
  return `Wind of ${amount(speed, 'metre')} per second${toward}, Beaufort ${number}, ${name}.`;
}

/** Return the clause of the light. */
function light(look) {
  if (!known(look?.sunElevation)) return '';
  const degrees = Math.round(look.sunElevation);
  if (degrees < 0) return 'The sun is below the horizon.';
  return `The sun stands ${degrees} degree${degrees === 1 ? '' : 's'} above the horizon.`;
}

/** Return the sea in a few sentences. */
export function describeSea({ document: sea, look, paused, few, playback }) {
  const statistics = sea?.statistics?.realised ?? sea?.statistics?.specified ?? {};
  const water =
    known(sea?.depth) && sea.depth < 1e6 ? `The water is ${amount(sea.depth, 'metre')} deep.` : '';
  return [
    playback ? 'A recorded sea is played.' : '',
    waves(statistics),
    wind(sea?.wind),
    water,
    light(look),
    few ? 'Few waves are shown beside the sea of the same spectrum.' : '',
    paused ? 'Time stands still.' : '',
  ]
    .filter(Boolean)
    .join(' ');
}

/** Return the relative luminance of an sRGB colour, each channel 0 to 255 (WCAG 2.2). */
export function luminance([red, green, blue]) {
  const linear = [red, green, blue].map((value) => {
    const share = value / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
}

/** Return the contrast ratio of two colours (WCAG 2.2), 1 to 21. */
export function contrast(first, second) {
  const [low, high] = [luminance(first), luminance(second)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

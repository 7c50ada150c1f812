// SPDX-License-Identifier: Apache-2.0

// Slices in grey: black up to the lower end of a window of values, white from its upper end on.

const steps = 8;

/** The function of a grey window; equal steps of it look equal. @returns {Object} */
export function greyColors(lower, upper) {
  const linear = (s) => (s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4);
  return {points: Array.from({length: steps + 1}, (_, i) => {
    const grey = linear(i / steps);
    return {value: lower + (upper - lower) * i / steps, extinction: 0, color: [grey, grey, grey]};
  })};
}

/** The window of a slice; null: it is not grey. @returns {?number[]} lower and upper end */
export function windowOf(slice) {
  const points = slice.colors?.points;
  if (points?.length !== steps + 1) return null;
  const isGrey = points.every(({color}) =>
    Array.isArray(color) && color[0] === color[1] && color[1] === color[2]);
  return isGrey ? [points[0].value, points[steps].value] : null;
}

// SPDX-License-Identifier: Apache-2.0

/** The brightness of a light: that of its brightest channel. */
const brightness = (light) => Math.max(...(light.color ?? [1, 1, 1]));
const scaled = (light, factor) =>
  ({...light, color: (light.color ?? [1, 1, 1]).map((channel) => channel * factor)});
const sum = (lights) => lights.reduce((total, light) => total + brightness(light), 0);

/**
 * Adds a light; all together stay as bright as they were, so that the picture is not burnt.
 * @param {Object[]} lights of a scene file
 * @param {Object} light without a color
 * @returns {Object[]}
 */
export function withLight(lights, light) {
  const total = sum(lights) || 1, count = lights.length;
  const share = total / (count + 1);
  return [...lights.map((old) => scaled(old, count / (count + 1))),
    {...light, color: [share, share, share]}];
}

/** Removes a light; the others get its brightness. */
export function withoutLight(lights, i) {
  const rest = lights.filter((_, k) => k !== i);
  const left = sum(rest);
  return left > 0 ? rest.map((light) => scaled(light, sum(lights) / left)) : rest;
}

/**
 * A direction for the next light beside the one at the eye: a key from the upper left, then a fill
 * from the right, and so on in turn.
 * @param {?Object} camera of a scene file
 * @param {number} count of lights that are there
 * @returns {number[]}
 */
export function nextDirection(camera, count) {
  if (!camera) return [0, 1, -1];
  const unit = (v) => v.map((part) => part / Math.hypot(...v));
  const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
  const forward = unit(camera.focal_point.map((part, a) => part - camera.position[a]));
  const right = unit(cross(forward, camera.up ?? [0, 1, 0]));
  const up = cross(right, forward);
  const [x, y] = count % 2 === 1 ? [0.8, -0.7] : [-0.9, -0.1];
  const direction = forward.map((part, a) => part + x * right[a] + y * up[a]);
  return unit(direction).map((part) => Number(part.toFixed(4)));
}

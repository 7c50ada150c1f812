// SPDX-License-Identifier: Apache-2.0

// Where slices lie in the world, and how they are seen. The world of a patient goes to the left, to
// the back and up; a slice is seen from the feet, from the front, or from the left of the patient.

const names = {true: ['Sagittal', 'Coronal', 'Axial'],
  false: ['Across x', 'Across y', 'Across z']};

/** @param {number} axis that the slice crosses @param {boolean} anatomical @returns {string} */
export function sliceName(axis, anatomical) {
  return names[anatomical][axis];
}

/** The axes of the world along columns and rows of a slice. @returns {number[]} */
export function planeAxes(axis) {
  return [[1, 2], [0, 2], [0, 1]][axis];
}

/** Whether rows go down where the world's coordinate grows: 1, or up: -1. @returns {number} */
export function rowSign(axis, anatomical) {
  return axis === 2 && anatomical ? 1 : -1;
}

/**
 * Goes on by some slices, and to the middle of a voxel where the steps are those of a grid.
 * @param {Object} steps of an axis, as the message "scene" has them
 * @param {number} position
 * @param {number} by slices
 * @returns {number}
 */
export function stepped(steps, position, by) {
  const {first, count, step, positions} = steps;
  if (positions) {
    let nearest = 0;
    positions.forEach((at, i) => {
      if (Math.abs(at - position) < Math.abs(positions[nearest] - position)) nearest = i;
    });
    return positions[Math.min(positions.length - 1, Math.max(0, nearest + by))];
  }
  if (!count) return position + by * step;
  const index = Math.round((position - first) / step) + by;
  return first + step * Math.min(count - 1, Math.max(0, index));
}

/** @returns {number} length of the vector from one point to another */
export function distance(from, to) {
  return Math.hypot(...from.map((at, a) => to[a] - at));
}

/** @returns {number} degrees between the lines from the second point to the others */
export function angle([first, vertex, last]) {
  const a = first.map((at, i) => at - vertex[i]), b = last.map((at, i) => at - vertex[i]);
  const cross = [[1, 2], [2, 0], [0, 1]].map(([i, j]) => a[i] * b[j] - a[j] * b[i]);
  const dot = a.reduce((sum, at, i) => sum + at * b[i], 0);
  return Math.atan2(Math.hypot(...cross), dot) * 180 / Math.PI;
}

/**
 * Where a position is seen in a picture of the volume.
 * @param {number[][]} matrix of a frame's overlay
 * @returns {?{x: number, y: number}} fractions of the picture; null behind the camera
 */
export function projected(matrix, position) {
  const [x, y, w] = matrix.map((row) =>
    row[0] * position[0] + row[1] * position[1] + row[2] * position[2] + row[3]);
  return w > 0 ? {x: x / w, y: y / w} : null;
}

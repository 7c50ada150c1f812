// SPDX-License-Identifier: Apache-2.0

// A Gaussian's contour |K (v - c)| = 1 as an ellipse of the plot. Only its place on the screen is
// computed here; the program renders.

/**
 * The matrix of a Gaussian in a plane of two channels, in units of the plot.
 * @param {number[][]} matrix K by rows
 * @param {number[]} columns of the two channels in K
 * @param {number[]} units data per unit of the plot, along x and y; y is negative
 * @returns {number[][]} rows of two numbers
 */
export function planeMatrix(matrix, columns, units) {
  return matrix.map((row) => columns.map((column, k) => row[column] * units[k]));
}

/**
 * Half axes of the ellipse: angles and lengths, the longer one first.
 * @param {number[][]} rows of planeMatrix()
 * @returns {{angle: number, lengths: number[]}}
 */
export function ellipseOf(rows) {
  let a = 0, b = 0, d = 0;
  for (const [x, y] of rows) {
    a += x * x;
    b += x * y;
    d += y * y;
  }
  const middle = (a + d) / 2, half = Math.hypot((a - d) / 2, b);
  const length = (eigenvalue) => Math.min(1 / Math.sqrt(Math.max(eigenvalue, 1e-12)), 1e5);
  // The eigenvector of the least eigenvalue is the longest axis.
  const angle = half < 1e-12 * middle ? 0 : Math.atan2(2 * b, a - d) / 2 + Math.PI / 2;
  return {angle, lengths: [length(middle - half), length(middle + half)]};
}

/**
 * K after the plane was mapped by `map`, so that the contour follows.
 * @param {number[][]} matrix K by rows
 * @param {number[]} columns of the two channels in K
 * @param {number[]} units as above
 * @param {number[][]} map 2 × 2, in units of the plot
 * @returns {number[][]}
 */
export function mappedMatrix(matrix, columns, units, map) {
  const [[p, q], [r, s]] = map;
  const determinant = p * s - q * r;
  const inverse = [[s / determinant, -q / determinant], [-r / determinant, p / determinant]];
  return matrix.map((row) => {
    const [x, y] = columns.map((column, k) => row[column] * units[k]);
    const mapped = [x * inverse[0][0] + y * inverse[1][0], x * inverse[0][1] + y * inverse[1][1]];
    const result = [...row];
    columns.forEach((column, k) => { result[column] = mapped[k] / units[k]; });
    return result;
  });
}

/** The map that turns by an angle. */
export function turning(angle) {
  return [[Math.cos(angle), -Math.sin(angle)], [Math.sin(angle), Math.cos(angle)]];
}

/** The map that stretches by a factor along an angle. */
export function stretching(angle, factor) {
  const c = Math.cos(angle), s = Math.sin(angle), more = factor - 1;
  return [[1 + more * c * c, more * c * s], [more * c * s, 1 + more * s * s]];
}

/**
 * How far the contour |K (v - c)| = 1 reaches along a channel.
 * @param {number[][]} matrix K by rows
 * @param {number} column of the channel
 * @returns {?number} null: without end
 */
export function reachOf(matrix, column) {
  const size = matrix[0].length;
  // Solves KᵀK x = e; x at the column is the square of the reach.
  const rows = Array.from({length: size}, (_, i) => [
    ...Array.from({length: size}, (__, j) =>
      matrix.reduce((sum, row) => sum + row[i] * row[j], 0)), i === column ? 1 : 0]);
  for (let i = 0; i < size; ++i) {
    let pivot = i;
    for (let k = i + 1; k < size; ++k) {
      if (Math.abs(rows[k][i]) > Math.abs(rows[pivot][i])) pivot = k;
    }
    [rows[i], rows[pivot]] = [rows[pivot], rows[i]];
    if (rows[i][i] === 0) return null;
    for (let k = 0; k < size; ++k) {
      if (k === i) continue;
      const factor = rows[k][i] / rows[i][i];
      rows[k] = rows[k].map((value, j) => value - factor * rows[i][j]);
    }
  }
  const square = rows[column][size] / rows[column][column];
  return square > 0 && Number.isFinite(square) ? Math.sqrt(square) : null;
}

/** K with another reach along a channel; along the others it stays. */
export function withReach(matrix, column, reach) {
  const factor = reachOf(matrix, column) / reach;
  return matrix.map((row) => row.map((value, k) => (k === column ? value * factor : value)));
}

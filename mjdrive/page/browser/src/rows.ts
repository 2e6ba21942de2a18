// Steps of a drive, one row each: t [s], x, y [m], speed [m/s], and the acceleration and steering that were done then.

export const COLUMNS = 6;

/** Rows after a time [s]. Each panel brings the last ones again, since some panels never come. */
export function rowsAfter(rows: Float32Array, time: number): Float32Array {
  let at = rows.length;
  while (at && rows[at - COLUMNS] > time) at -= COLUMNS;
  return rows.subarray(at);
}

/** Time of the last row [s]; before all others if there is none. */
export const endOf = (rows: Float32Array): number => (rows.length ? rows[rows.length - COLUMNS] : -Infinity);

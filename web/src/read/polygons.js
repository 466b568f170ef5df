// Divides polygons into triangles with the diagonals that the service takes: the fan around the first corner where it covers the
// polygon properly, otherwise ears (Meisters 1975), first those beside a straight corner.

const CORNERS_MAX = 5000; // of a polygon whose ears are sought; others stay fans

// `corners`: triangles, fans of polygons; those of one polygon have one number in `faceOf`. Changed in place.
export function divide({ corners, faceOf, vertices }) {
  for (let from = 0; from < faceOf.length;) {
    let to = from + 1;
    while (faceOf[to] === faceOf[from]) to += 1;
    if (to - from > 1 && to - from < CORNERS_MAX) {
      const polygon = [corners[from * 3], corners[from * 3 + 1]];
      for (let at = from; at < to; at += 1) polygon.push(corners[at * 3 + 2]);
      const triangles = ears(flat(polygon, vertices));
      if (triangles) corners.set(triangles.map((at) => polygon[at]), from * 3);
    }
    from = to;
  }
}

// The polygon without the coordinate in which its normal is largest, so that it runs counter-clockwise.
function flat(polygon, vertices) {
  const at = (i, axis) => vertices[polygon[i] * 3 + axis];
  const normal = [0, 0, 0];
  for (let i = 2; i < polygon.length; i += 1) {
    for (let axis = 0; axis < 3; axis += 1) {
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      normal[axis] += (at(i - 1, u) - at(0, u)) * (at(i, v) - at(0, v)) - (at(i - 1, v) - at(0, v)) * (at(i, u) - at(0, u));
    }
  }
  const size = normal.map(Math.abs);
  const axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  const [u, v] = normal[axis] < 0 ? [(axis + 2) % 3, (axis + 1) % 3] : [(axis + 1) % 3, (axis + 2) % 3];
  return polygon.map((_, i) => [at(i, u), at(i, v)]);
}

// Which way three points turn: 1 counter-clockwise, 0 as far as the numbers can tell not at all.
function turn([ax, ay], [bx, by], [cx, cy]) {
  const [left, right] = [(ax - cx) * (by - cy), (ay - cy) * (bx - cx)];
  const area = left - right;
  return Math.abs(area) <= 3.4e-16 * (Math.abs(left) + Math.abs(right)) ? 0 : Math.sign(area);
}

// Triangles as numbers of corners; null: the fan it is.
function ears(points) {
  const count = points.length;
  if (points.every((point, i) => i < 2 || turn(points[0], points[i - 1], point) > 0)) return null;
  const previous = points.map((_, i) => (i + count - 1) % count);
  const next = points.map((_, i) => (i + 1) % count);
  const bend = points.map((point, i) => turn(points[previous[i]], point, points[next[i]]));
  const isGone = points.map(() => false);
  const isBlocked = (...own) => {
    const [a, b, c] = own.map((i) => points[i]);
    return points.some((p, i) => !isGone[i] && bend[i] <= 0 && ![a, b, c].some(([x, y]) => x === p[0] && y === p[1])
      && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0);
  };
  // 0: no ear, 1: an ear, 2: one beside a straight corner.
  const rankOf = (i) => {
    if (bend[i] <= 0 || isBlocked(previous[i], i, next[i])) return 0;
    return bend[previous[i]] === 0 || bend[next[i]] === 0 ? 2 : 1;
  };
  const rank = points.map((_, i) => rankOf(i));
  const triangles = [];
  for (let clipped = 2, from = 0; clipped < count; clipped += 1) {
    const around = points.map((_, i) => (from + i) % count).filter((i) => !isGone[i]);
    const ear = around.find((i) => rank[i] === 2) ?? around.find((i) => rank[i] === 1) ?? around.findLast((i) => bend[i] === 0);
    if (ear === undefined || (clipped === 2 && rank[ear] === 0)) return null;
    const [a, c] = [previous[ear], next[ear]];
    triangles.push(a, ear, c);
    isGone[ear] = true;
    rank[ear] = 0;
    next[a] = c;
    previous[c] = a;
    for (const i of [a, c]) bend[i] = turn(points[previous[i]], points[i], points[next[i]]);
    for (const i of [previous[a], a, c, next[c]]) rank[i] = rankOf(i);
    from = c;
  }
  return triangles;
}

// The way of a transparency method to one texel, from the surfaces that lie over the texel's centre.

// The depth of a convex polygon at a point; null outside it.
function depthAt(corners, x, y) {
  let sign = 0;
  for (let i = 0; i < corners.length; i++) {
    const [ax, ay] = corners[i], [bx, by] = corners[(i + 1) % corners.length];
    const side = Math.sign((bx - ax) * (y - ay) - (by - ay) * (x - ax));
    if (side && sign && side !== sign) return null;
    sign ||= side;
  }
  const [a, b, c] = corners;
  const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
  const v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
  return a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]);
}

function cornersOf(numbers) {
  const corners = [];
  for (let i = 4; i < numbers.length; i += 3) corners.push(numbers.slice(i, i + 3));
  return corners;
}

// The layers at a texel, nearest first, and what is behind them; null where they are not what the truth shows.
function layersAt(figure, all, x, y) {
  const group = figure.parentElement;
  if (!group.dataset.layers || !all.truth) return null;
  const { size, background, surfaces } = group.layers ??= JSON.parse(group.dataset.layers);
  if (size[0] !== all.picture.width || size[1] !== all.picture.height) return null;
  const found = [];
  surfaces.forEach((numbers, order) => {
    const depth = depthAt(cornersOf(numbers), x + .5, y + .5);
    if (depth !== null) found.push({ order, depth, color: numbers.slice(0, 3), alpha: numbers[3] });
  });
  // Of two at the same depth the later one is in front.
  found.sort((a, b) => a.depth - b.depth || b.order - a.order);
  const end = found.findIndex(l => l.alpha === 1), opaque = found[end];
  const glass = end < 0 ? found : found.slice(0, end);
  let left = 1;
  const sum = [0, 0, 0];
  for (const layer of [...glass, { color: opaque?.color ?? background, alpha: 1 }]) {
    layer.share = layer.alpha * left;
    layer.color.forEach((c, i) => { sum[i] += c * layer.share; });
    left *= 1 - layer.alpha;
  }
  const at = 4 * (y * all.truth.width + x);
  if (sum.some((v, i) => Math.abs(v * 255 - all.truth.data[at + i]) > 2)) return null;
  const base = { color: opaque?.color ?? background, depth: opaque?.depth ?? 1, name: opaque ? "the opaque surface" : "the background" };
  // The fragments of all texels, and the nodes of a pool with eight for each.
  const pool = () => group.pool ??= { nodes: 8 * size[0] * size[1], fragments: fragments(group.layers) };
  return { glass, base, pool, drawn: [0, 1, 2].map(i => all.picture.data[at + i]) };
}

// The number of fragments in front of what is opaque, over all texels.
function fragments({ size, surfaces }) {
  const all = surfaces.map(numbers => {
    const corners = cornersOf(numbers);
    return { corners, alpha: numbers[3], top: Math.min(...corners.map(c => c[1])), bottom: Math.max(...corners.map(c => c[1])) };
  });
  let count = 0;
  for (let y = .5; y < size[1]; y++) {
    const row = all.filter(s => s.top <= y && y <= s.bottom);
    for (let x = .5; x < size[0]; x++) {
      const found = row.map(s => [depthAt(s.corners, x, y), s.alpha]).filter(([depth]) => depth !== null);
      const end = Math.min(1, ...found.filter(f => f[1] === 1).map(f => f[0]));
      count += found.filter(([depth, alpha]) => alpha < 1 && depth < end).length;
    }
  }
  return count;
}

// The one choice of layers that gives the drawn colour over what is behind them, a bit for each.
function chosen(glass, base, drawn) {
  if (glass.length > 12) return null;
  const matches = [];
  for (let bits = 0; bits < 1 << glass.length; bits++) {
    const color = base.color.map((behind, c) =>
      glass.reduceRight((sum, l, i) => bits >> i & 1 ? l.color[c] * l.alpha + sum * (1 - l.alpha) : sum, behind));
    if (color.every((v, c) => Math.abs(v * 255 - drawn[c]) <= 1.5)) matches.push(bits);
  }
  return matches.length === 1 ? matches[0] : null;
}

// The one way to share four samples among layers and what is behind them that gives the drawn colour.
function samples(glass, base, drawn) {
  const all = [...glass, base], matches = [];
  if (all.length > 12) return null;
  const next = (i, left, counts) => {
    if (i === all.length - 1) {
      const full = [...counts, left];
      const near = drawn.every((d, c) => Math.abs(full.reduce((s, n, j) => s + n * all[j].color[c], 0) / 4 * 255 - d) <= 1.5);
      if (near) matches.push(full);
      return;
    }
    for (let n = 0; n <= left; n++) next(i + 1, left - n, [...counts, n]);
  };
  next(0, 4, []);
  return matches.length === 1 ? matches[0] : null;
}

// The transmittance in front of each layer that four moments of the absorbance tell, as `moment_transmittance.wgsl` computes it.
function transmittances(glass) {
  const layers = glass.map(l => ({ z: 2 * l.depth - 1, absorbance: -Math.log2(Math.max(1 - l.alpha, 4.54e-5)) }));
  const total = layers.reduce((s, l) => s + l.absorbance, 0);
  const moment = n => layers.reduce((s, l) => s + l.absorbance * l.z ** n, 0) / total * (1 - 5e-7) + (n % 2 ? 0 : .375 * 5e-7);
  const [b1, b2, b3, b4] = [1, 2, 3, 4].map(moment);
  const mixed = b3 - b1 * b2, d1 = b2 - b1 * b1, l = mixed / d1, d2 = b4 - b2 * b2 - mixed * l;
  return layers.map(({ z }) => {
    const first = z - b1, second = z * z - b2 - first * l;
    const own = 1 / (1 + first * first / d1 + second * second / d2);
    // The two other places are the roots of a parabola.
    const c2 = Math.abs(second / d2) < 1e-9 ? 1e-9 : second / d2, c1 = first / d1 - c2 * l, c0 = 1 - b1 * first / d1 + c2 * (b1 * l - b2);
    const half = -(c1 + (c1 < 0 ? -1 : 1) * Math.sqrt(Math.max(c1 * c1 - 4 * c0 * c2, 0))) / 2;
    const [near, far] = [half / c2, c0 / half].sort((a, b) => a - b);
    const others = far < z ? 1 - own : near < z ? (far * z - (far + z) * b1 + b2) / ((near - z) * (near - far)) : 0;
    return 2 ** (-total * Math.min(Math.max(own / 4 + others, 0), 1));
  });
}

// Notes for each layer, and a last line, in the terms of a method.
const TELL = {
  "weighted-blended": ({ glass, base }) => {
    const weights = glass.map(l => l.alpha * Math.max(.01, 3000 * (1 - l.depth) ** 3));
    const total = glass.reduce((s, l, i) => s + l.alpha * weights[i], 0), revealage = glass.reduce((s, l) => s * (1 - l.alpha), 1);
    const part = i => glass[i].alpha * weights[i] / total * (1 - revealage);
    return [glass.map((_, i) => `weight ${weights[i].toPrecision(3)}: ${percent(part(i))} of the colour`), `revealage: ${percent(revealage)} of ${base.name}`];
  },
  "moment-based": ({ glass, base }) => {
    const told = transmittances(glass), exact = glass.map(l => l.share / l.alpha);
    const total = glass.reduce((s, l, i) => s + l.alpha * told[i], 0), left = glass.reduce((s, l) => s * (1 - l.alpha), 1);
    const part = i => glass[i].alpha * told[i] / total * (1 - left);
    return [glass.map((_, i) => `transmittance ${told[i].toFixed(3)} told, ${exact[i].toFixed(3)} exact: ${percent(part(i))} of the colour`),
      `absorbance: ${percent(left)} of ${base.name} left`];
  },
  "linked-lists": ({ glass, base, pool, drawn }) => {
    const { nodes, fragments } = pool(), all = `${fragments} fragments, ${nodes} nodes`;
    if (fragments <= nodes) return [glass.map(() => "in the list"), all];
    const bits = chosen(glass, base, drawn);
    if (bits === null) return [[], `${all}: the drawn colour doesn't tell which layers found no room`];
    return [glass.map((_, i) => bits >> i & 1 ? "in the list" : "found no room"), all];
  },
  "depth-peeling": ({ glass }, passes) => {
    const k = passes >> 1;
    return [glass.map((_, i) => i < k ? `peel ${i + 1} of ${k}` : "not reached"), lost(glass.length - k, k)];
  },
  "dual-depth-peeling": ({ glass }, passes) => {
    const k = (passes - 1) >> 1, n = glass.length;
    const peel = i => Math.min(i, n - 1 - i);
    const side = i => i === n - 1 - i ? "both" : i < n - 1 - i ? "front" : "back";
    return [glass.map((_, i) => peel(i) < k ? `peel ${peel(i) + 1} of ${k}, ${side(i)}` : "not reached"), lost(n - 2 * k, k)];
  },
  "unsorted": ({ glass, base }) => {
    const drawn = [...glass].sort((a, b) => a.order - b.order), notes = new Map();
    let stored = base.depth, by = null;
    drawn.forEach((l, i) => {
      const kept = l.depth < stored;
      notes.set(l, `drawn ${i + 1} of ${glass.length}` + (kept ? "" : `, rejected behind layer ${glass.indexOf(by) + 1}`));
      if (kept) [stored, by] = [l.depth, l];
    });
    return [glass.map(l => notes.get(l)), ""];
  },
  "depth-write-off": ({ glass }) => {
    const drawn = [...glass].sort((a, b) => a.order - b.order);
    return [glass.map((l, i) => `blended ${drawn.indexOf(l) + 1} of ${glass.length}, in order ${glass.length - i}`), ""];
  },
  "alpha-test": ({ glass }) => [glass.map(l => l.alpha >= .5 ? "opaque" : "discarded"), ""],
  "alpha-to-coverage": sampled,
  "stochastic": sampled,
};

function sampled({ glass, base, drawn }) {
  const counts = samples(glass, base, drawn);
  const asked = l => `alpha asks for ${(4 * l.alpha).toFixed(1)} of 4 samples`;
  if (!counts) return [glass.map(asked), "The drawn colour doesn't tell in how many samples each layer is seen."];
  return [glass.map((l, i) => `${asked(l)}, seen in ${counts[i]}`), `${base.name}: seen in ${counts.at(-1)} of 4 samples`];
}

function percent(share) {
  return `${(100 * share).toFixed(1)} %`;
}

function lost(count, peels) {
  return count > 0 ? `${count} ${count === 1 ? "layer" : "layers"} lost after ${peels} ${peels === 1 ? "peel" : "peels"}` : "every layer taken";
}

// The story of a texel in lines; none where there are no layers to tell of.
function story(figure, all, x, y) {
  const found = layersAt(figure, all, x, y);
  if (!found) return [];
  const { glass, base } = found, { method, passes } = figure.dataset;
  if (!glass.length) return [`no layer in front of ${base.name}`];
  // Which of two at one depth a peel takes is not the scene's to say.
  const tied = glass.some((l, i) => i && l.depth - glass[i - 1].depth < 1e-5);
  const tell = tied && method.endsWith("peeling") ? null : TELL[method];
  const [notes, last] = tell ? tell(found, Number(passes)) : [[], ""];
  const most = 12;
  const lines = glass.slice(0, most).map((l, i) =>
    `layer ${i + 1}: depth ${l.depth.toFixed(3)}, alpha ${l.alpha.toFixed(2)}, ${percent(l.share)} of the truth${notes[i] ? "; " + notes[i] : ""}`);
  if (glass.length > most) lines.push(`and ${glass.length - most} more`);
  if (last) lines.push(last);
  return lines;
}

// LDR-FLIP (Andersson and others 2020) at 67 pixels per degree, as nv-flip computes it: a map of values from
// 0 to 1.
const PPD = 67;
const GREEN_TO_BLUE = (() => {
  const [g, b] = [[0, 1, 0], [0, 0, 1]].map(c => hunt(lab(...c)));
  return Math.pow(hyab(g, b), 0.7);
})();

function linear(code) {
  const v = code / 255;
  return v <= 0.04045 ? v / 12.92 : Math.pow((v + 0.055) / 1.055, 2.4);
}

function xyz(r, g, b) {
  return [
    (10135552 / 24577794) * r + (8788810 / 24577794) * g + (4435075 / 24577794) * b,
    (2613072 / 12288897) * r + (8788810 / 12288897) * g + (887015 / 12288897) * b,
    (1425312 / 73733382) * r + (8788810 / 73733382) * g + (70074185 / 73733382) * b,
  ];
}

function rgb(x, y, z) {
  return [
    3.241003275 * x - 1.537398934 * y - 0.498615861 * z,
    -0.969224334 * x + 1.875930071 * y + 0.041554224 * z,
    0.055639423 * x - 0.204011202 * y + 1.057148933 * z,
  ];
}

function white() {
  return xyz(1, 1, 1);
}

function lab(r, g, b) {
  const n = white();
  const f = v => v > Math.pow(6 / 29, 3) ? Math.cbrt(v) : v / (3 * Math.pow(6 / 29, 2)) + 4 / 29;
  const [x, y, z] = xyz(r, g, b).map((v, i) => f(v / n[i]));
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

function hunt([l, a, b]) {
  return [l, 0.01 * l * a, 0.01 * l * b];
}

function hyab(p, q) {
  return Math.abs(p[0] - q[0]) + Math.hypot(p[1] - q[1], p[2] - q[2]);
}

// Convolves a plane with one kernel along rows and another along columns. Border texels repeat outside the
// plane.
function convolve(plane, width, height, across, down) {
  const radius = (across.length - 1) / 2;
  const between = new Float64Array(plane.length), result = new Float64Array(plane.length);
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) {
    let sum = 0;
    for (let i = -radius; i <= radius; i++) {
      sum += across[i + radius] * plane[y * width + Math.min(Math.max(x + i, 0), width - 1)];
    }
    between[y * width + x] = sum;
  }
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) {
    let sum = 0;
    for (let i = -radius; i <= radius; i++) {
      sum += down[i + radius] * between[Math.min(Math.max(y + i, 0), height - 1) * width + x];
    }
    result[y * width + x] = sum;
  }
  return result;
}

function kernel(radius, of) {
  return Array.from({ length: 2 * radius + 1 }, (_, i) => of(i - radius));
}

// The spatial filters by contrast sensitivity: they blur red-green and blue-yellow more than luminance.
const SENSITIVITY = [[[1, 0.0047]], [[1, 0.0053]], [[34.1, 0.04], [13.5, 0.025]]];

function blurred(planes, width, height) {
  const radius = Math.ceil(3 * Math.sqrt(0.04 / (2 * Math.PI * Math.PI)) * PPD);
  return planes.map((plane, channel) => {
    const parts = SENSITIVITY[channel].map(([a, b]) => {
      const one = kernel(radius, x => Math.exp(-Math.PI * Math.PI * (x / PPD) * (x / PPD) / b));
      const sum = one.reduce((s, v) => s + v, 0);
      return { one, weight: a * Math.sqrt(Math.PI / b), sum: sum * sum };
    });
    const all = parts.reduce((s, p) => s + p.weight * p.sum, 0);
    const result = new Float64Array(plane.length);
    for (const part of parts) {
      const one = convolve(plane, width, height, part.one, part.one);
      for (let i = 0; i < one.length; i++) result[i] += one[i] * part.weight / all;
    }
    return result;
  });
}

// Returns the strengths of edges and of points in luminance.
function features(luminance, width, height) {
  const deviation = 0.5 * 0.082 * PPD, radius = Math.ceil(3 * deviation);
  const gauss = kernel(radius, x => Math.exp(-x * x / (2 * deviation * deviation)));
  const sum = gauss.reduce((s, v) => s + v, 0);
  const smooth = gauss.map(v => v / sum);
  const bySign = list => {
    const of = sign => list.reduce((s, v) => s + (v * sign > 0 ? v * sign : 0), 0);
    const [plus, minus] = [of(1), of(-1)];
    return list.map(v => v > 0 ? v / plus : v / minus);
  };
  const at = i => i - radius;
  const edge = bySign(gauss.map((v, i) => -at(i) * v));
  const point = bySign(gauss.map((v, i) => (at(i) * at(i) / (deviation * deviation) - 1) * v));
  return [edge, point].map(one => {
    const x = convolve(luminance, width, height, one, smooth);
    const y = convolve(luminance, width, height, smooth, one);
    return x.map((v, i) => Math.hypot(v, y[i]));
  });
}

// Returns a picture as the eye sees it: filtered colours, and the strengths of features.
function seen({ data, width, height }) {
  const n = white(), size = width * height;
  const planes = [0, 1, 2].map(() => new Float64Array(size));
  for (let i = 0; i < size; i++) {
    const [x, y, z] = xyz(linear(data[4 * i]), linear(data[4 * i + 1]), linear(data[4 * i + 2])).map((v, c) => v / n[c]);
    planes[0][i] = 116 * y - 16;
    planes[1][i] = 500 * (x - y);
    planes[2][i] = 200 * (y - z);
  }
  const strengths = features(planes[0].map(v => (v + 16) / 116), width, height);
  const [ly, cx, cz] = blurred(planes, width, height);
  const colors = Array.from({ length: size }, (_, i) => {
    const y = (ly[i] + 16) / 116, x = y + cx[i] / 500, z = y - cz[i] / 200;
    const color = rgb(x * n[0], y * n[1], z * n[2]).map(v => Math.min(Math.max(v, 0), 1));
    return hunt(lab(...color));
  });
  return { colors, strengths };
}

function flip(truth, picture) {
  const [a, b] = [truth, picture].map(seen);
  const knee = 0.4 * GREEN_TO_BLUE;
  return Float64Array.from(a.colors, (color, i) => {
    const power = Math.pow(hyab(color, b.colors[i]), 0.7);
    const difference = power < knee
      ? 0.95 / knee * power
      : 0.95 + (power - knee) / (GREEN_TO_BLUE - knee) * 0.05;
    const feature = Math.max(...a.strengths.map((s, f) => Math.abs(s[i] - b.strengths[f][i])));
    return Math.min(Math.pow(difference, 1 - Math.sqrt(Math.SQRT1_2 * feature)), 1);
  });
}

// Differences between pictures and the truth, and the enlarged view of all four.
const MODES = ["picture", "truth", "difference", "FLIP"];
const pixels = new WeakMap();

// Returns the codes of a decoded picture.
function read(image) {
  if (!pixels.has(image)) {
    const canvas = make("canvas", { width: image.naturalWidth, height: image.naturalHeight });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    pixels.set(image, context.getImageData(0, 0, canvas.width, canvas.height));
  }
  return pixels.get(image);
}

function ready(image) {
  return image.decode().then(() => image.naturalWidth > 0, () => false);
}

// From black through purple and orange to white: the map “magma” (van der Walt and Smith 2015), by a few of
// its colours.
const MAGMA = [[0, 0, 4], [28, 16, 68], [79, 18, 123], [129, 37, 129], [181, 54, 122], [229, 80, 100], [251, 135, 97], [254, 194, 135], [252, 253, 191]];

function magma(value) {
  const at = Math.min(Math.max(value, 0), 1) * (MAGMA.length - 1), low = Math.min(Math.floor(at), MAGMA.length - 2);
  return MAGMA[low].map((v, i) => Math.round(v + (MAGMA[low + 1][i] - v) * (at - low)));
}

// Returns one picture's texels, the truth's texels, and both differences.
function compared(figure) {
  if (figure.compared) return figure.compared;
  const truthImage = figure.parentElement.querySelector(".truth img");
  const picture = read(figure.querySelector("img")), truth = truthImage ? read(truthImage) : null;
  if (!truth || truth.width !== picture.width || truth.height !== picture.height) {
    return figure.compared = { picture };
  }
  let largest = 0;
  const size = picture.width * picture.height;
  for (let i = 0; i < 4 * size; i++) {
    if (i % 4 < 3) largest = Math.max(largest, Math.abs(picture.data[i] - truth.data[i]));
  }
  // The scale: the next power of two, in codes.
  const range = Math.min(Math.pow(2, Math.ceil(Math.log2(Math.max(largest, 1)))), 255);
  const difference = new ImageData(picture.width, picture.height), map = new ImageData(picture.width, picture.height);
  const values = flip(truth, picture);
  for (let i = 0; i < size; i++) {
    for (let c = 0; c < 3; c++) {
      difference.data[4 * i + c] = Math.round(127.5 + 127.5 * (picture.data[4 * i + c] - truth.data[4 * i + c]) / range);
      map.data[4 * i + c] = magma(values[i])[c];
    }
    difference.data[4 * i + 3] = map.data[4 * i + 3] = 255;
  }
  const mean = values.reduce((s, v) => s + v, 0) / size;
  figure.dataset.mapMean = mean;
  return figure.compared = { picture, truth, difference, map, values, range, largest, mean };
}

function imageOf(all, mode) {
  return { picture: all.picture, truth: all.truth, difference: all.difference, FLIP: all.map }[mode];
}

function thumbnail(image) {
  const canvas = make("canvas", { width: image.width, height: image.height, "aria-hidden": "true" });
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

// Adds the differences below a picture when it becomes visible.
async function complete(figure) {
  if (figure.dataset.complete) return;
  figure.dataset.complete = "1";
  const images = [figure.querySelector("img"), figure.parentElement.querySelector(".truth img")].filter(Boolean);
  if (!(await Promise.all(images.map(ready))).every(Boolean)) return;
  const all = compared(figure), method = figure.dataset.method;
  const button = (mode, content, text) => {
    const one = make("button", { type: "button", "data-mode": mode, "aria-label": `Enlarge: ${mode} of ${method}` }, content);
    if (text) one.append(make("span", {}, text));
    one.addEventListener("click", () => enlarge(figure, mode, one));
    return one;
  };
  const image = figure.querySelector("img"), caption = figure.querySelector("figcaption");
  const place = document.createComment("");
  image.replaceWith(place);
  place.replaceWith(button("picture", image));
  if (all.truth) {
    caption.before(
      button("difference", thumbnail(all.difference), all.largest ? `difference ±${all.range}` : "no difference"),
      button("FLIP", thumbnail(all.map), "FLIP map"));
  }
}

const dialog = make("dialog", { id: "viewer", "aria-labelledby": "viewer-title" });
const view = { figure: null, mode: "picture", x: 0, y: 0 };

const modeButtons = MODES.map(mode => {
  const button = make("button", { type: "button", "data-view": mode }, mode);
  button.addEventListener("click", () => { view.mode = mode; draw(); });
  return button;
});
const large = make("canvas", { class: "large", tabindex: "0", role: "img" });
const scaleText = make("p", { class: "scale" });
const values = make("div", { class: "values", role: "status" });
const close = make("button", { type: "button" }, "Close");
close.addEventListener("click", () => dialog.close());
dialog.append(
  make("h2", { id: "viewer-title" }), make("div", { class: "modes" }, ...modeButtons, close),
  large, scaleText, values,
  make("p", { class: "cap" }, "The arrow keys or the pointer choose a texel; 1 to 4 choose a picture; Escape closes."));

function enlarge(figure, mode, from) {
  Object.assign(view, { figure, mode, from });
  const { width, height } = compared(figure).picture;
  view.x = Math.min(view.x || width >> 1, width - 1);
  view.y = Math.min(view.y || height >> 1, height - 1);
  if (!dialog.isConnected) document.querySelector("main").append(dialog);
  dialog.showModal();
  large.focus();
  draw();
}

function draw() {
  const all = compared(view.figure), image = imageOf(all, view.mode) ?? all.picture;
  const { method, adapter } = view.figure.dataset, setting = view.figure.parentElement.dataset.setting;
  const scene = view.figure.closest(".scene").dataset.name;
  $("viewer-title").textContent = `${scene}: ${method}${setting ? " at " + setting : ""} on ${adapter}`;
  for (const button of modeButtons) {
    button.setAttribute("aria-pressed", button.dataset.view === view.mode);
    button.disabled = !imageOf(all, button.dataset.view);
  }
  const zoom = Math.max(1, Math.floor(1024 / image.width));
  large.width = image.width * zoom;
  large.height = image.height * zoom;
  large.setAttribute("aria-label", `${view.mode}, ${image.width} by ${image.height} texels`);
  const context = large.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(thumbnail(image), 0, 0, large.width, large.height);
  if (zoom >= 4) {
    context.strokeStyle = "rgb(128 128 128 / .4)";
    context.lineWidth = 1;
    context.beginPath();
    for (let x = 0; x <= image.width; x++) { context.moveTo(x * zoom + .5, 0); context.lineTo(x * zoom + .5, large.height); }
    for (let y = 0; y <= image.height; y++) { context.moveTo(0, y * zoom + .5); context.lineTo(large.width, y * zoom + .5); }
    context.stroke();
  }
  for (const [color, width] of [["#000", 5], ["#fff", 2]]) {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.strokeRect(view.x * zoom - 1, view.y * zoom - 1, zoom + 2, zoom + 2);
  }
  const at = 4 * (view.y * image.width + view.x);
  const codes = of => of ? [0, 1, 2].map(c => String(of.data[at + c]).padStart(4)).join("") : "none";
  const lines = [`texel ${view.x},${view.y}`, `picture    ${codes(all.picture)}`];
  if (all.truth) {
    const difference = [0, 1, 2].map(c => all.picture.data[at + c] - all.truth.data[at + c]);
    const signed = difference.map(d => (d > 0 ? "+" + d : String(d)).padStart(4)).join("");
    lines.push(`truth      ${codes(all.truth)}`, `difference ${signed}`, `FLIP       ${all.values[at / 4].toFixed(4)} (mean ${all.mean.toFixed(4)})`);
  }
  lines.push(`etalon explain ${view.figure.dataset.case} --texel ${view.x},${view.y} --adapter ${adapter}`);
  values.textContent = lines.join("\n");
  const bar = colors => { const i = make("i", {}); i.style.background = `linear-gradient(to right, ${colors})`; return i; };
  const scales = {
    difference: () => [`−${all.range}`, bar("#000, #808080, #fff"), `+${all.range} codes per channel; grey is none`],
    FLIP: () => ["0", bar(MAGMA.map(c => `rgb(${c})`).join()), "1: the error that an eye sees at 67 pixels per degree"],
  };
  scaleText.replaceChildren(...(scales[view.mode]?.() ?? ["codes of 8 bits: red, green, blue"]));
}

large.addEventListener("pointermove", event => {
  const box = large.getBoundingClientRect(), { width, height } = compared(view.figure).picture;
  view.x = Math.min(Math.max(Math.floor((event.clientX - box.left) / box.width * width), 0), width - 1);
  view.y = Math.min(Math.max(Math.floor((event.clientY - box.top) / box.height * height), 0), height - 1);
  draw();
});
dialog.addEventListener("keydown", event => {
  const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  const { width, height } = compared(view.figure).picture;
  if (move) {
    view.x = Math.min(Math.max(view.x + move[0], 0), width - 1);
    view.y = Math.min(Math.max(view.y + move[1], 0), height - 1);
    event.preventDefault();
  } else if (/^[1-4]$/.test(event.key) && imageOf(compared(view.figure), MODES[event.key - 1])) {
    view.mode = MODES[event.key - 1];
  } else {
    return;
  }
  draw();
});
dialog.addEventListener("close", () => view.from?.focus());

const watcher = new IntersectionObserver(entries => {
  for (const entry of entries) if (entry.isIntersecting) complete(entry.target);
}, { rootMargin: "300px" });
for (const figure of document.querySelectorAll("figure.shot")) watcher.observe(figure);

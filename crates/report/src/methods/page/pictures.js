// The truth, a method's picture, their difference and FLIP: side by side, and enlarged.
const MODES = ["truth", "picture", "difference", "FLIP"];
const pixels = new WeakMap();

// Returns the codes of a picture; null if it could not be decoded.
function read(image) {
  if (!image?.naturalWidth) return null;
  if (!pixels.has(image)) {
    const canvas = make("canvas", { width: image.naturalWidth, height: image.naturalHeight });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    pixels.set(image, context.getImageData(0, 0, canvas.width, canvas.height));
  }
  return pixels.get(image);
}

// From black through purple and orange to white: the map “magma” (van der Walt and Smith 2015), by a few of
// its colours.
const MAGMA = [[0, 0, 4], [28, 16, 68], [79, 18, 123], [129, 37, 129], [181, 54, 122], [229, 80, 100], [251, 135, 97], [254, 194, 135], [252, 253, 191]];

function magma(value) {
  const at = Math.min(Math.max(value, 0), 1) * (MAGMA.length - 1), low = Math.min(Math.floor(at), MAGMA.length - 2);
  return MAGMA[low].map((v, i) => Math.round(v + (MAGMA[low + 1][i] - v) * (at - low)));
}

// Returns the texels of a method's picture, and of the truth if there is one of this size.
function texels(shot) {
  const [truth, picture] = [shot.parentElement.querySelector(".truth img"), shot.querySelector("img")].map(read);
  return { picture, truth: truth && picture && truth.width === picture.width && truth.height === picture.height ? truth : null };
}

// Decodes all pictures of a scene. The largest difference of any of them, in codes, is white in all differences.
function decode(scene) {
  return scene.decoded ??= (async () => {
    await Promise.all([...scene.querySelectorAll(".pictures img")].map(image => image.decode().catch(() => {})));
    for (const shot of scene.querySelectorAll(".shot")) {
      const { picture, truth } = texels(shot);
      shot.largest = truth ? picture.data.reduce((most, code, i) => Math.max(most, Math.abs(code - truth.data[i])), 0) : 0;
      scene.white = Math.max(scene.white ?? 1, shot.largest);
    }
  })();
}

// Returns the texels of a picture and of the truth, and both differences.
function compared(shot) {
  if (shot.compared) return shot.compared;
  const { picture, truth } = texels(shot), { white } = shot.closest(".scene");
  if (!truth) return shot.compared = { picture };
  const difference = new ImageData(picture.width, picture.height), FLIP = new ImageData(picture.width, picture.height);
  const values = flip(truth, picture);
  values.forEach((value, i) => {
    const codes = [0, 1, 2].map(c => Math.abs(picture.data[4 * i + c] - truth.data[4 * i + c]));
    difference.data.set([...codes.map(code => Math.round(255 * code / white)), 255], 4 * i);
    FLIP.data.set([...magma(value), 255], 4 * i);
  });
  return shot.compared = { picture, truth, difference, FLIP, values, mean: values.reduce((s, v) => s + v, 0) / values.length };
}

function canvasOf(image) {
  const canvas = make("canvas", { width: image.width, height: image.height, "aria-hidden": "true" });
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}

// Shows the pictures of the scene's chosen method side by side, above those of all methods.
async function compare(group) {
  const scene = group.closest(".scene");
  await decode(scene);
  const shots = [...group.querySelectorAll(".shot")].filter(shot => texels(shot).picture);
  if (!shots.length) return;
  if (!group.querySelector(".compared")) {
    group.prepend(make("div", { class: "compared" }));
    for (const shot of shots) {
      const image = shot.querySelector("img"), button = make("button", { type: "button", "aria-label": `Compare ${shot.dataset.method}` });
      image.replaceWith(button);
      button.append(image);
      button.addEventListener("click", () => {
        scene.dataset.method = shot.dataset.method;
        compare(group);
      });
    }
  }
  const shot = shots.find(one => one.dataset.method === scene.dataset.method) ?? shots[0], { method } = shot.dataset;
  for (const one of shots) one.querySelector("button").setAttribute("aria-pressed", one === shot);
  const all = compared(shot);
  const captions = {
    picture: method,
    difference: `difference, white = ${scene.white} of 255 codes; here at most ${shot.largest}`,
    FLIP: `FLIP, white = 1; here ${all.mean?.toFixed(4)} on average`,
  };
  group.querySelector(".compared").replaceChildren(...MODES.filter(mode => all[mode]).map(mode => {
    const button = make("button", { type: "button", "data-mode": mode, "aria-label": `Enlarge: ${mode} of ${method}` }, canvasOf(all[mode]));
    button.addEventListener("click", () => enlarge(shot, mode, button));
    return make("figure", {}, button, make("figcaption", {}, captions[mode] ?? mode));
  }));
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
  const all = compared(view.figure), image = all[view.mode] ?? all.picture;
  const { method, adapter } = view.figure.dataset, setting = view.figure.parentElement.dataset.setting;
  const scene = view.figure.closest(".scene").dataset.name;
  $("viewer-title").textContent = `${scene}: ${method}${setting ? " at " + setting : ""} on ${adapter}`;
  for (const button of modeButtons) {
    button.setAttribute("aria-pressed", button.dataset.view === view.mode);
    button.disabled = !all[button.dataset.view];
  }
  const zoom = Math.max(1, Math.floor(1024 / image.width));
  large.width = image.width * zoom;
  large.height = image.height * zoom;
  large.setAttribute("aria-label", `${view.mode}, ${image.width} by ${image.height} texels`);
  const context = large.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.drawImage(canvasOf(image), 0, 0, large.width, large.height);
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
    difference: () => ["0", bar("#000, #fff"), `${view.figure.closest(".scene").white} of 255 codes per channel`],
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
  } else if (/^[1-4]$/.test(event.key) && compared(view.figure)[MODES[event.key - 1]]) {
    view.mode = MODES[event.key - 1];
  } else {
    return;
  }
  draw();
});
dialog.addEventListener("close", () => view.from?.focus());

const watcher = new IntersectionObserver(entries => {
  for (const entry of entries) if (entry.isIntersecting) compare(entry.target);
}, { rootMargin: "300px" });
for (const group of document.querySelectorAll(".pictures")) watcher.observe(group);

// The pictures of a run side by side, in the order of its cases.
"use strict";

/** Width and height of a tile as the suite makes it, in texels. */
const TILE = 16;
/** The smallest and the largest side of a tile on the page, in pixels. */
const SIDES = [4, 48];

/** What the mosaic shows. */
const TILES = "One tile per case, as this device draws it. Wrong ones have a frame. Click a tile to see its case.";

/** Returns the texels of a tile as pixels. */
function pixels(tile) {
  const image = new ImageData(TILE, TILE);
  for (let i = 0; i < TILE * TILE; i += 1) {
    image.data.set(tile.subarray(3 * i, 3 * i + 3), 4 * i);
    image.data[4 * i + 3] = 255;
  }
  return image;
}

/** Returns a picture of a tile. */
function thumbnail(tile) {
  const canvas = make("canvas", { class: "thumbnail", width: TILE, height: TILE, "aria-hidden": "true" });
  canvas.getContext("2d").putImageData(pixels(tile), 0, 0);
  return canvas;
}

/** A canvas with a place for each case. Painting takes what was added since the last time. */
class Mosaic {
  #canvas = $("tiles");
  #context = this.#canvas.getContext("2d", { alpha: false });
  #scratch = make("canvas", { width: TILE, height: TILE }).getContext("2d");
  /** The numbers of the cases in the order of their places. */
  #order = [];
  #columns = 1;
  /** The side of a place in pixels of the canvas. */
  #side = 0;
  #colors = {};
  /** Tiles and kinds by number. */
  #tiles = new Map();
  /** The places to paint. */
  #unpainted = new Set();
  #isPacked = false;

  constructor() {
    new ResizeObserver(() => this.#lay()).observe($("mosaic"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#lay());
  }

  /** Empties the mosaic. It gets this many places. */
  begin(count) {
    this.#order = Array.from({ length: count }, (_, number) => number);
    this.#isPacked = false;
    this.#tiles.clear();
    $("mosaic").hidden = count === 0;
    $("tile-name").textContent = TILES;
    this.#lay();
  }

  /** Adds a case: its tile, or null if nothing was drawn, and the class of its frame, or an empty text. */
  add(number, tile, mark) {
    this.#tiles.set(number, { tile, mark });
    // While the mosaic is not packed, the place of a case is its number.
    this.#unpainted.add(number);
  }

  /** Leaves out the cases that were not drawn, or gives every case a place again. */
  pack(isPacked, count) {
    if (this.#order.length === 0 || this.#isPacked === isPacked) {
      return;
    }
    this.#isPacked = isPacked;
    const numbers = Array.from({ length: count }, (_, number) => number);
    const isShown = (number) => {
      const { tile = null, mark = "" } = this.#tiles.get(number) ?? {};
      return tile !== null || mark !== "";
    };
    const shown = numbers.filter(isShown);
    this.#order = isPacked && shown.length > 0 ? shown : numbers;
    this.#lay();
  }

  /** Returns the number of the case at a place of the page; null if there is none. */
  at(clientX, clientY) {
    const { left, top, width } = this.#canvas.getBoundingClientRect();
    const side = (this.#side * width) / this.#canvas.width;
    const [column, row] = [clientX - left, clientY - top].map((distance) => Math.floor(distance / side));
    const isInside = column >= 0 && column < this.#columns && row >= 0;
    return isInside ? (this.#order[row * this.#columns + column] ?? null) : null;
  }

  /** Chooses the largest tiles with which the mosaic is about half a window high, and paints everything. */
  #lay() {
    const width = this.#canvas.parentElement.clientWidth - 2 * Number.parseFloat(getComputedStyle(this.#canvas.parentElement).paddingLeft);
    const count = this.#order.length;
    if (width <= 0 || count === 0) {
      return;
    }
    const height = Math.max(240, 0.47 * innerHeight);
    let [least, side] = SIDES;
    const rows = () => Math.ceil(count / Math.max(1, Math.floor(width / side)));
    while (side > least && rows() * side > height) {
      side -= 1;
    }
    this.#side = Math.max(1, Math.round(side * devicePixelRatio));
    this.#columns = Math.max(1, Math.floor((width * devicePixelRatio) / this.#side));
    const used = Math.min(this.#columns, count);
    this.#canvas.width = used * this.#side;
    this.#canvas.height = Math.ceil(count / this.#columns) * this.#side;
    this.#canvas.style.width = `${this.#canvas.width / devicePixelRatio}px`;
    const style = getComputedStyle(document.documentElement);
    for (const name of ["panel", "line", "f", "r", "b"]) {
      this.#colors[name] = style.getPropertyValue(`--${name}`);
    }
    this.#context.fillStyle = this.#colors.panel;
    this.#context.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
    // Tiles that shrink are averaged; larger ones show their texels.
    this.#context.imageSmoothingEnabled = this.#side < TILE;
    for (const place of this.#order.keys()) {
      this.#unpainted.add(place);
    }
    this.paint();
  }

  paint() {
    if (this.#side === 0) {
      return;
    }
    for (const place of this.#unpainted) {
      this.#paintAt(place);
    }
    this.#unpainted.clear();
  }

  #paintAt(place) {
    const [column, row] = [place % this.#columns, Math.floor(place / this.#columns)];
    const gap = this.#side >= 8 ? 1 : 0;
    const [x, y, side] = [column * this.#side, row * this.#side, this.#side - gap];
    const { tile = null, mark = "none" } = this.#tiles.get(this.#order[place]) ?? {};
    const fill = (color, inset) => {
      this.#context.fillStyle = this.#colors[color];
      this.#context.fillRect(x + inset, y + inset, side - 2 * inset, side - 2 * inset);
    };
    // A place without a picture is a pale square before its case is done, and a dot after.
    fill(mark === "" || mark === "none" ? "panel" : mark, 0);
    const inset = mark === "" || mark === "none" ? 0 : Math.max(1, Math.round(side / 5));
    if (tile !== null) {
      this.#scratch.putImageData(pixels(tile), 0, 0);
      this.#context.drawImage(this.#scratch.canvas, x + inset, y + inset, side - 2 * inset, side - 2 * inset);
    } else if (mark === "") {
      fill("line", Math.floor(side / 3));
    } else if (mark === "none") {
      this.#context.globalAlpha = 0.5;
      fill("line", 0);
      this.#context.globalAlpha = 1;
    }
  }
}

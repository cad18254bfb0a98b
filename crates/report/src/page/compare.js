// The pictures of a frame: a slider between the first two, and the values of the texel under the pointer.
function compare(root) {
  for (const strip of root.querySelectorAll(".strip[data-window]")) {
    const texels = texelsOf(strip.dataset);
    const pictures = strip.querySelector(".shots");
    const status = make("p", { class: "said", role: "status" });
    pictures.append(slider(pictures));
    pictures.after(status);
    const shots = [...strip.querySelectorAll(".shot")];
    const cursors = shots.map(shot => {
      const cursor = make("i", { class: "ring cursor", hidden: true });
      shot.append(cursor);
      return cursor;
    });
    const point = ([x, y, sample]) => {
      status.textContent = texels.text(x, y, sample);
      for (const cursor of cursors) {
        Object.assign(cursor.style, texels.box(x, y, sample));
        cursor.hidden = false;
      }
    };
    for (const shot of shots) {
      shot.addEventListener("pointermove", event => {
        const box = shot.getBoundingClientRect();
        const at = texels.at((event.clientX - box.x) / box.width, (event.clientY - box.y) / box.height);
        if (at) point(at);
      });
    }
    if (strip.dataset.wrong) status.textContent = texels.text(...strip.dataset.wrong.split(" ").map(Number));
  }
}

// Returns functions from a place on a picture to a texel, and from a texel to its box and its values.
function texelsOf({ window, values, runs }) {
  const [left, top, width, height, samples] = window.split(" ").map(Number);
  const [texts, repeated] = [values.split("\n"), runs.split(" ").map(Number)];
  // The samples of all texels lie side by side, with a gap of a texel.
  const tile = samples > 1 ? width + 1 : width;
  const columns = tile * samples - (tile - width);
  const percent = (part, whole) => 100 * part / whole + "%";
  const valueOf = index => {
    for (let i = 0; i < repeated.length; i += 2) if ((index -= repeated[i + 1]) < 0) return texts[repeated[i]];
    return "";
  };
  return {
    at: (across, down) => {
      const [column, y] = [Math.floor(across * columns), Math.floor(down * height)];
      const [x, sample] = [column % tile, Math.floor(column / tile)];
      return x >= 0 && x < width && y >= 0 && y < height && sample < samples ? [x, y, sample] : null;
    },
    box: (x, y, sample) => ({
      left: percent(sample * tile + x, columns), top: percent(y, height), width: percent(1, columns), height: percent(1, height),
    }),
    text: (x, y, sample) => "texel " + (left + x) + "," + (top + y) + (samples > 1 ? " sample " + sample : "") + ": " +
      (valueOf((y * width + x) * samples + sample) || "no value is kept"),
  };
}

// Returns the first two pictures over each other, with the slider that divides them.
function slider(pictures) {
  const [first, second] = pictures.children;
  const shot = first.querySelector(".shot").cloneNode(true);
  const top = second.querySelector("img").cloneNode();
  top.className = "top";
  shot.querySelector("img").after(top);
  const names = [first, second].map(figure => figure.querySelector("figcaption").textContent);
  const input = make("input", { type: "range", min: 0, max: 100, value: 50, "aria-label": "Between " + names.join(" and ") });
  const divide = () => shot.style.setProperty("--at", input.value + "%");
  input.addEventListener("input", divide);
  divide();
  return make("figure", { class: "over" }, shot, input, make("figcaption", {}, names[0] + " | " + names[1]));
}


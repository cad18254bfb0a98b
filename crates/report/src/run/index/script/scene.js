// Cases as intended: texts, scene, JSON, shaders and picture, from one script per area next to the page.
const withArea = beside("etalonArea", name => data.scripts.find(([area]) => area === name)?.[1]);

const areaOf = id => id.split("/")[0];

// Returns a case of the run from an area's script.
function heldCase(held, one) {
  return held && one && held.cases[one.file.name]?.[one.id.slice(one.file.name.length)];
}

// Returns the values of a case's axes and of the names derived from them.
function valuesOf(template, id) {
  const names = new Map(id.split("/").filter(part => part.includes("=")).map(part => {
    const at = part.indexOf("=");
    return [part.slice(0, at), part.slice(at + 1)];
  }));
  const values = new Map();
  const place = axis => template.axes[axis].findIndex(([name]) => name === names.get(axis));
  for (const axis of Object.keys(template.axes)) values.set(axis, (template.axes[axis][place(axis)] || [])[1]);
  for (const [name, [axis, shift, list]] of Object.entries(template.derived)) {
    const at = (place(axis) + shift) % template.axes[axis].length;
    values.set(name, list ? list[at] : template.axes[axis][at][1]);
  }
  return values;
}

function expanded(value, values) {
  if (typeof value === "string") return value.startsWith("$") && values.has(value.slice(1)) ? values.get(value.slice(1)) : value;
  if (Array.isArray(value)) return value.map(one => expanded(one, values));
  if (value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, expanded(one, values)]));
}

// Returns what a case is made from: its file's, with the case's values and the changes that its id names.
function changed(template, id) {
  const values = valuesOf(template, id);
  const scene = expanded(template.scene, values);
  const names = (id.match(/\/with=([^\/]*)/) || ["", ""])[1].split("+");
  for (const name of names) {
    for (const [pointer, value] of Object.entries(template.changes?.[name] || {})) {
      const keys = pointer.split("/").slice(1);
      const last = keys.pop();
      keys.reduce((inside, key) => inside[key], scene)[last] = expanded(value, values);
    }
  }
  return scene;
}

// Puts lists of numbers on one line and indents everything else.
function readable(value) {
  return JSON.stringify(value, null, 2).replace(/\[[^\[\]{}"]*\]/g, list => list.replace(/\s+/g, " "));
}

function picture(held, place, id, width) {
  return make("img", { src: held.pictures[place], alt: "Reference picture of " + id, width, loading: "lazy", class: "texels" });
}

const foldedText = (title, content) => make("details", {}, make("summary", {}, title), make("pre", {}, content));

// Returns what a case should draw; filled when its area's script has loaded.
function meant(id, tell) {
  const section = make("section", { id: "meant", hidden: true });
  withArea(areaOf(id)).then(held => {
    const one = cases[numberOf.get(id)];
    const found = heldCase(held, one);
    if (!found) return;
    const [scene, place, used] = found;
    const template = held.files[one.file.name];
    section.append(make("h2", {}, "The case"));
    if (template) {
      tell(template.about);
      section.append(make("p", { class: "soft" }, template.spec.join("; ")));
    }
    if (place >= 0) {
      section.append(make("figure", { class: "reference" }, picture(held, place, id, 160),
        make("figcaption", {}, "Reference: the rasterizer's picture of what is read back first")));
    }
    section.append(make("pre", { class: "scene" }, held.scenes[scene].map(line => held.lines[line]).join("\n")));
    if (template) {
      const json = { [template.key]: changed(template, id) };
      section.append(foldedText("JSON of " + template.key, readable(json)));
    }
    for (const name of held.used[used]) section.append(foldedText("shaders/" + name + ".wgsl", held.shaders[name]));
    section.hidden = false;
  });
  return section;
}

// The most pictures of a gallery that are shown at a time.
const THUMBNAILS = 400;

function showGallery(area) {
  enter("");
  const grid = make("div", { class: "gallery" });
  const note = make("p", { class: "soft", role: "status" }, "Loading …");
  withArea(area).then(held => {
    const found = held ? cases.filter(one => heldCase(held, one)) : [];
    note.textContent = held ? counted(found.length, "case") : "This folder has no pictures of this area.";
    const more = from => {
      for (const one of found.slice(from, from + THUMBNAILS)) {
        const place = heldCase(held, one)[1];
        grid.append(make("a", { href: addressOf(one.id) },
          place >= 0 ? picture(held, place, one.id, 64) : make("span", { class: "none" }, "no picture"),
          make("code", {}, one.id.slice(area.length + 1))));
      }
      if (from + THUMBNAILS < found.length) {
        const button = make("button", { type: "button" }, "Show more");
        button.addEventListener("click", () => { button.remove(); more(from + THUMBNAILS); });
        grid.append(button);
      }
    };
    more(0);
  });
  return { leads: () => [neighbours(null)], title: "Gallery: " + area, content: [note, grid] };
}


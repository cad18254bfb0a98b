// Compares two adapters' tables place by place, and opens the samples that a link names.
const sections = [...document.querySelectorAll("section.adapter")];
const one = $("one");
const other = $("other");
const ratios = $("ratios");

const show = () => {
  const [a, b] = [sections[one.value], sections[other.value]];
  const copy = a.cloneNode(true);
  copy.querySelectorAll("[id]").forEach((e) => e.removeAttribute("id"));
  copy.querySelector("h2").remove();
  const places = (root) => [...root.querySelectorAll(".heat tbody td, .list tbody td:nth-child(2)")];
  const theirs = places(b);
  places(copy).forEach((cell, i) => {
    const [x, y] = [Number(cell.dataset.rate), Number(theirs[i].dataset.rate)];
    if (cell.classList.contains("none")) return;
    cell.removeAttribute("style");
    if (!(x > 0 && y > 0)) {
      cell.textContent = "–";
      return;
    }
    const ratio = x / y;
    cell.textContent = `×${ratio >= 100 ? ratio.toFixed(0) : ratio.toPrecision(3)}`;
    cell.classList.add(ratio >= 1 ? "faster" : "slower");
    cell.style.setProperty("--h", `${Math.min(Math.abs(Math.log2(ratio)) * 20, 60).toFixed(0)}%`);
  });
  // Intervals and shares belong to one adapter.
  copy.querySelectorAll(".list tr").forEach((row) => [...row.children].slice(2).forEach((e) => e.remove()));
  copy.querySelectorAll(".list thead th:nth-child(2)").forEach((e) => { e.textContent = "ratio"; });
  copy.querySelectorAll(".heat caption").forEach((e) => { e.textContent = e.textContent.replace(/,.*/, ", ratio of rates"); });
  ratios.replaceChildren(...copy.children);
};

if (sections.length > 1) {
  for (const select of [one, other]) {
    sections.forEach((section, i) => select.add(new Option(section.dataset.adapter, i)));
    select.addEventListener("change", show);
  }
  other.value = "1";
  $("compare").hidden = false;
  show();
}

addEventListener("hashchange", () => reveal(location.hash.slice(1)));
reveal(location.hash.slice(1));

// Shows a setting of a scene: the slider, and links to settings.
function show(scene, index) {
  const input = scene.querySelector(".setting input");
  if (!input) return;
  const names = JSON.parse(input.dataset.names);
  input.value = index;
  input.setAttribute("aria-valuetext", names[index]);
  scene.querySelector(".setting output").textContent = names[index];
  for (const part of scene.querySelectorAll(".at")) {
    part.classList.toggle("off", part.dataset.at !== String(index));
  }
}

for (const input of document.querySelectorAll(".setting input")) {
  input.disabled = false;
  input.addEventListener("input", () => show(input.closest(".scene"), Number(input.value)));
}
for (const link of document.querySelectorAll("a[data-go]")) {
  link.addEventListener("click", event => {
    const scene = $(link.hash.slice(1));
    show(scene, Number(link.dataset.go));
    const pictures = scene.querySelector(".pictures:not(.off)");
    if (pictures) {
      event.preventDefault();
      history.pushState(null, "", link.hash);
      follow();
      pictures.scrollIntoView({ block: "center" });
      pictures.setAttribute("tabindex", "-1");
      pictures.focus({ preventScroll: true });
    }
  });
}
for (const key of document.querySelectorAll("button.key")) {
  key.addEventListener("click", () => {
    const pressed = key.getAttribute("aria-pressed") !== "true";
    for (const other of key.parentElement.querySelectorAll(".key")) other.setAttribute("aria-pressed", "false");
    key.setAttribute("aria-pressed", pressed);
  });
}

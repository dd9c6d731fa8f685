
"use strict";
// The page tells everything without this; here are a filter, a swap and a copy button.
const every = (selector, root = document) => [...root.querySelectorAll(selector)];

function filter() {
  const wanted = document.getElementById("wanted").value.toLowerCase().split(/\s+/).filter(Boolean);
  const checks = every("main [data-check]");
  for (const check of every("[data-check]")) {
    const text = check.textContent.toLowerCase();
    check.hidden = !wanted.every((word) => text.includes(word));
  }
  for (const section of every("main > section")) {
    const inside = every("[data-check]", section);
    section.hidden = inside.length > 0 && inside.every((check) => check.hidden);
  }
  const shown = checks.filter((check) => !check.hidden).length;
  document.getElementById("shown").value = wanted.length ? `${shown} of ${checks.length} checks` : "";
}

function swap(article) {
  const [expected, got] = ["expected", "got"].map((kind) => article.querySelector(`img[data-kind=${kind}]`));
  if (!expected || !got) return;
  const sources = [expected.src, got.src];
  const caption = got.closest("figure").querySelector("figcaption");
  const button = article.querySelector(".swap button");
  const show = (swapped) => {
    [expected.src, got.src] = swapped ? [sources[1], sources[0]] : sources;
    expected.closest("figure").querySelector("figcaption").textContent = swapped ? "got" : "expected";
    caption.textContent = swapped ? "expected" : "got";
    button.setAttribute("aria-pressed", String(swapped));
  };
  button.parentElement.hidden = false;
  button.addEventListener("click", () => show(button.getAttribute("aria-pressed") === "false"));
}

async function copy(button) {
  const source = button.parentElement.querySelector("pre");
  try {
    await navigator.clipboard.writeText(source.textContent);
  } catch {
    getSelection().selectAllChildren(source);
    document.execCommand("copy");
  }
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = "Copy"; }, 1500);
}

document.getElementById("filter").hidden = false;
document.getElementById("wanted").addEventListener("input", filter);
every("article").forEach(swap);
for (const button of every(".copy button")) {
  button.hidden = false;
  button.addEventListener("click", () => copy(button));
}

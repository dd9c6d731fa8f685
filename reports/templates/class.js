"use strict";
// The page tells everything without this, the bands filter without it too; here is a search.
const wanted = document.getElementById("wanted");
const rows = [...document.querySelectorAll("tr[data-band]")];
document.getElementById("search").hidden = false;
wanted.addEventListener("input", () => {
  const words = wanted.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const row of rows) row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
});

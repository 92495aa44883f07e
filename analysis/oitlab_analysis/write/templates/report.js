"use strict";
// Tables. A click on a column head sorts by it, another click turns the order round. Rows without a
// value stay last either way.
for (const button of document.querySelectorAll("th button")) {
  button.addEventListener("click", () => {
    const head = button.parentElement, table = head.closest("table");
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of table.querySelectorAll("th")) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const column = head.cellIndex;
    const rows = [...table.tBodies[0].rows].map(row => [row.cells[column]?.dataset.key ?? "", row]);
    const collator = new Intl.Collator("en", { numeric: true });
    rows.sort(([x], [y]) => {
      if (x === "" || y === "") return (x === "") - (y === "");
      const difference = x - y;
      const result = isNaN(difference) ? collator.compare(x, y) : difference;
      return down ? -result : result;
    });
    table.tBodies[0].append(...rows.map(([, row]) => row));
  });
}

// The filter shows the rows that contain all its words.
for (const filter of document.querySelectorAll("input.filter")) {
  filter.addEventListener("input", () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const section = filter.closest("section"), rows = section.querySelector("table").tBodies[0].rows;
    let shown = 0;
    for (const row of rows) {
      row.hidden = !words.every(word => row.textContent.toLowerCase().includes(word));
      shown += !row.hidden;
    }
    section.querySelector("output.shown").textContent = words.length ? `${shown} of ${rows.length}` : "";
  });
}

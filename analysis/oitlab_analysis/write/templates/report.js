"use strict";
// The tables. Each is built when its section comes into sight: a page may hold many.
const parsed = (section, name) => JSON.parse(section.querySelector(`script.${name}`)?.textContent ?? "[]");
const sectionOf = element => element.closest("section");

// By the number behind the text, or as a reader would sort texts; rows without a value stay last.
const collator = new Intl.Collator("en", { numeric: true });
function compareRows(field, number) {
  return (a, b, rowA, rowB, column, direction) => {
    const [x, y] = [rowA, rowB].map(row => row.getData())
        .map(data => data.sort[field] ?? (number ? "" : data[field]) ?? "");
    if (x === "" || y === "") return ((x === "") - (y === "")) * (direction === "asc" ? 1 : -1);
    return typeof x === "number" && typeof y === "number" ? x - y : collator.compare(x, y);
  };
}

// A filter of numbers: <2, >=1, 1..3; anything else must be part of the text.
function passes(text, value, number) {
  const wanted = text.trim().toLowerCase();
  const range = wanted.match(/^(-?[\d.e+-]+)\s*\.\.\s*(-?[\d.e+-]+)$/);
  const bound = wanted.match(/^(<=|>=|<|>|=)\s*(-?[\d.e+-]+)$/);
  if (range && number !== undefined) return number >= Number(range[1]) && number <= Number(range[2]);
  if (bound && number !== undefined) {
    const limit = Number(bound[2]);
    return { "<": number < limit, ">": number > limit, "<=": number <= limit, ">=": number >= limit,
             "=": number === limit }[bound[1]];
  }
  return !range && !bound && String(value ?? "").toLowerCase().includes(wanted);
}

function buildTable(section) {
  if (section.table) return section.table;
  const { columns, rows } = parsed(section, "rows");
  rows.forEach((row, index) => { row.id = index; });
  const shown = (cell, value) => {  // text only: names come from files
    const span = document.createElement("span");
    span.textContent = value ?? "–";
    const { status, verdict } = cell.getRow().getData();
    if (cell.getField() === "verdict") span.className = verdict ?? "";
    if (cell.getField() === "frame" && status) span.className = status;
    return span;
  };
  const table = section.table = new Tabulator(section.querySelector(".table"), {
    data: rows,
    index: "id",
    maxHeight: "62vh",
    layout: "fitDataFill",
    placeholder: "no row passes the filters",
    columnDefaults: { resizable: "header", headerSortTristate: true, headerWordWrap: true },
    columns: columns.map(({ field, title, hint, hidden, number }) => ({
      field, title, visible: !hidden, frozen: field === "scene" || field === "label",
      hozAlign: number ? "right" : "left", headerTooltip: hint || false, headerFilter: "input",
      headerFilterFunc: (text, value, data) => passes(text, value, data.sort[field]),
      sorter: compareRows(field, number),
      maxInitialWidth: field === "label" ? 430 : field === "frame" ? 260 : 200,
      formatter: cell => shown(cell, cell.getValue()),
      tooltip: (event, cell) => cell.getRow().getData().hints[field] || cell.getValue() || "",
    })),
  });
  const words = () => section.querySelector("input.filter").value.toLowerCase().split(/\s+/).filter(Boolean);
  const tell = () => {
    const count = table.getDataCount("active");
    section.querySelector("output.shown").textContent = count < rows.length ? `${count} of ${rows.length}` : "";
  };
  section.querySelector("input.filter").addEventListener("input", () => {
    const texts = words();
    table.setFilter(data => {
      const text = columns.map(({ field }) => data[field] ?? "").join(" ").toLowerCase();
      return texts.every(word => text.includes(word));
    });
  });
  table.on("dataFiltered", () => setTimeout(tell));
  table.on("rowClick", (event, row) => choose(section, row));
  const chooser = section.querySelector(".chooser");
  for (const { field, title, hidden } of columns) {
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: !hidden });
    box.dataset.field = field;
    box.addEventListener("change", () => table[box.checked ? "showColumn" : "hideColumn"](field));
    const label = document.createElement("label");
    label.append(box, ` ${title}`);
    chooser.append(label);
  }
  return table;
}

// A click on a row shows its image as A.
function choose(section, row) {
  section.querySelector(".chosen")?.classList.remove("chosen");
  row.getElement().classList.add("chosen");
  const { place } = row.getData();
  if (!place) return;
  const viewer = viewerOf(section);
  viewer.show(place[0], place[1]);
  viewer.root.scrollIntoView({ block: "nearest", behavior: "instant" });
}

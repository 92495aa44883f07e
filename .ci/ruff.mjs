// Runs ruff's checks where only npm has it: its WebAssembly build under node.
//   node ruff.mjs MODULE_FOLDER RULES_JSON [--fix] FILE...
// MODULE_FOLDER holds node_modules; RULES_JSON is ruff.toml as JSON. Exit status 1 if a finding is left.
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const [modules, rules, ...rest] = process.argv.slice(2);
const fixes = rest[0] === "--fix";
const files = rest.slice(fixes ? 1 : 0);
const { Workspace, PositionEncoding } = createRequire(resolve(modules, "x.js"))("@astral-sh/ruff-wasm-nodejs");
const workspace = new Workspace(JSON.parse(rules), PositionEncoding.Utf16);

// The text with the edits of one fix; rows and columns count from 1.
function applied(text, edits) {
  const lines = text.split(/(?<=\n)/);
  const starts = [0];
  for (const line of lines) starts.push(starts.at(-1) + line.length);
  const offset = ({ row, column }) => starts[row - 1] + column - 1;
  const last = (a, b) => offset(b.location) - offset(a.location);
  for (const { content, location, end_location: end } of [...edits].sort(last))
    text = text.slice(0, offset(location)) + (content ?? "") + text.slice(offset(end));
  return text;
}

let findings = 0;
for (const file of files) {
  let text = readFileSync(file, "utf8");
  let found = workspace.check(text);
  if (fixes) {
    // One at a time, since edits of two fixes may overlap.
    for (let next; (next = found.find((finding) => finding.fix)); found = workspace.check(text)) {
      const changed = applied(text, next.fix.edits);
      if (changed === text) break;
      text = changed;
    }
    writeFileSync(file, text);
  }
  for (const { code, message, start_location: at } of found)
    console.log(`${file}:${at.row}:${at.column}: ${code ?? "syntax"} ${message}`);
  findings += found.length;
}
console.log(`ruff ${Workspace.version()}: ${files.length} files, ${findings} findings`);
process.exit(findings ? 1 : 0);

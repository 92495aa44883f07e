// The parts of Tabulator that the report's tables use; README.md says how tabulator.js is made of them.
import {
  Tabulator, SortModule, FilterModule, FrozenColumnsModule, FormatModule, InteractionModule,
  ResizeColumnsModule, ResizeTableModule, EditModule, TooltipModule,
} from "tabulator-tables";

Tabulator.registerModule([
  SortModule, FilterModule, FrozenColumnsModule, FormatModule, InteractionModule, ResizeColumnsModule,
  ResizeTableModule, EditModule, TooltipModule,
]);
window.Tabulator = Tabulator;

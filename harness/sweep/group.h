#pragma once

#include "sweep/group_rows.h"
#include "sweep/session.h"

namespace oitlab {

/// Measures the cells of a group in turn and gives each its row. What stops a cell is the reason of
/// its row, and what stops the whole group (a broken file, memory, a reference that cannot be
/// made) that of all rows that are not there yet. Throws DeviceLost, OutputError and Interrupted:
/// then the rows are not all there.
void measureGroup(Session& session, GroupRows& rows);

/// Whether each of `cells`, of one group, still fails where it is made ready and rendered once.
/// Throws DeviceLost and Interrupted.
bool stillFail(Session& session, const Experiment& experiment, const std::vector<CellSpec>& cells);

}  // namespace oitlab

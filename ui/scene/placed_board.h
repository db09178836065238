// SPDX-License-Identifier: GPL-3.0-or-later
// A board with its pose.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/so3.h"

namespace evical::ui {

struct PlacedBoard {
  Board board;
  RigidTransform world_from_board = {};
};

}  // namespace evical::ui

// SPDX-License-Identifier: GPL-3.0-or-later
// Whether 3D views can draw on this machine.
#pragma once

#include "ui/scene/view3d.h"

namespace evical::ui::test {

inline bool hasOpenGl() {
  View3D view;
  view.grab();
  return view.problem().isEmpty();
}

}  // namespace evical::ui::test

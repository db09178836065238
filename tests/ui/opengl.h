// SPDX-License-Identifier: GPL-3.0-or-later
// Availability of OpenGL for 3D views on this machine.
#pragma once

#include "ui/scene/view3d.h"

namespace evical::ui::test {

// With the value kNoEglVendor, this environment variable hides all OpenGL of a machine.
inline constexpr const char* kEglVendors = "__EGL_VENDOR_LIBRARY_FILENAMES";
inline constexpr const char* kNoEglVendor = "/nonexistent";

inline bool hasOpenGl() {
  View3D view;
  view.grab();
  return view.problem().isEmpty();
}

}  // namespace evical::ui::test

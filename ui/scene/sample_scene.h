// SPDX-License-Identifier: GPL-3.0-or-later
// A little of everything that the trajectory's scene draws: whoever has drawn it
// once has compiled all shaders.
#pragma once

class vtkRenderer;

namespace evical::ui {

void addSampleScene(vtkRenderer* renderer);

}  // namespace evical::ui

// SPDX-License-Identifier: GPL-3.0-or-later
// Contains every kind of object of the trajectory's scene: drawing it once compiles all shaders.
#pragma once

class vtkRenderer;

namespace evical::ui {

void addSampleScene(vtkRenderer* renderer);

}  // namespace evical::ui

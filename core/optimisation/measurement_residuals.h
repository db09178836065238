// Residual blocks of the measurements of cameras and IMUs. Each measurement belongs to the spline segment at
// its time with the current time offsets.
#pragma once

#include "core/optimisation/problem_builder.h"
#include "core/optimisation/view_circles.h"
#include "core/optimisation/view_cost.h"

namespace evical {

// Keeps a reference to `model`.
void addCircles(ProblemBuilder& builder, std::size_t camera, const CircleModel& model,
                const PixelErrors& pixel_errors);

void addImu(ProblemBuilder& builder, std::size_t imu);

}  // namespace evical

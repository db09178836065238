// What cameras and IMUs measured, as residual blocks: every measurement goes to the spline segment where the
// time offsets put it now.
#pragma once

#include "core/optimisation/circle_cost.h"
#include "core/optimisation/pixel_errors.h"
#include "core/optimisation/problem_builder.h"

namespace evical {

// Keeps a reference to `model`.
void addCircles(ProblemBuilder& builder, std::size_t camera, const CircleModel& model,
                const PixelErrors& pixel_errors);

void addImu(ProblemBuilder& builder, std::size_t imu);

}  // namespace evical

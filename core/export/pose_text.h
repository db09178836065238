// A sensor's pose as text for a document, a program or another program's file. Numbers are the
// shortest that read back exactly; quaternions are unit quaternions, in the order that each form states.
#pragma once

#include "core/report/shown_quantity.h"

#include <span>
#include <string>

namespace evical {

struct PoseForm {
  const char* name;   // "yaml"
  const char* title;  // "YAML"
  const char* use;    // one-line description of its use
  std::string (*write)(const SensorPose& pose);
};

std::span<const PoseForm> poseForms();

// Text of several sensors, one after the other.
std::string poseText(const PoseForm& form, std::span<const SensorPose> poses);

}  // namespace evical

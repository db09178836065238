// A sensor's pose as text to be put elsewhere: into a document, a program or another program's file. Numbers are the
// shortest that read back as the same; quaternions are unit ones, in the order that each form says.
#pragma once

#include "core/report/sensor_pose.h"

#include <span>
#include <string>

namespace evical {

struct PoseForm {
  const char* name;   // "yaml"
  const char* title;  // "YAML"
  const char* use;    // what it is good for, in a line
  std::string (*write)(const SensorPose& pose);
};

std::span<const PoseForm> poseForms();

// Of several sensors, one after the other.
std::string poseText(const PoseForm& form, std::span<const SensorPose> poses);

}  // namespace evical

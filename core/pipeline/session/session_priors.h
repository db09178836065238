// Priors of a session's sensors: `prior.cameras` and `prior.imus`, with the keys of result.yaml, so that
// sensors of an earlier result can be pasted.
#pragma once

#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"

#include <string>

namespace evical {

// Reads priors of the session's sensors. Sensors and reference must be set before. Throws CalibrationError
// (BadInput) with the place of the fault.
void readSensorPriors(const YamlNode& prior, Session& session);

// Indented for use below `prior:`; empty if there are no priors.
std::string sensorPriorsYaml(const Session& session);

}  // namespace evical

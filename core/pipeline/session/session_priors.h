// The part of a session that says what is known of its sensors beforehand: `prior.cameras` and `prior.imus`,
// in the keys of result.yaml, so that an earlier result's sensors can be pasted.
#pragma once

#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"

#include <string>

namespace evical {

// Into the priors of the session's sensors, which must be there already, as must its reference. Throws
// CalibrationError (BadInput) with the place of what is wrong.
void readSensorPriors(const YamlNode& prior, Session& session);

// Indented to stand below `prior:`; empty if nothing is known.
std::string sensorPriorsYaml(const Session& session);

}  // namespace evical

// Reports of a check, a maintenance and a repeat, for people and programs. Keys are a contract, the same in
// YAML and JSON.
#pragma once

#include "core/data/assessment.h"

#include <string>

namespace evical {

const char* verdictName(Verdict verdict);         // unchanged, changed, cannot_tell
const char* verdictWords(Verdict verdict);        // "cannot tell"
const char* sourceName(FindingSource source);     // recording, stops, trajectory, other_imu
const char* sourceWords(FindingSource source);    // "other IMU"
const char* outcomeName(RepeatOutcome outcome);   // fits, does_not_fit, failed
const char* outcomeWords(RepeatOutcome outcome);  // "does not fit"

std::string assessmentYaml(const CalibrationCheck& check);
std::string assessmentYaml(const Maintenance& maintenance);
std::string assessmentYaml(const Repeatability& repeat);

std::string assessmentJson(const CalibrationCheck& check);
std::string assessmentJson(const Maintenance& maintenance);
std::string assessmentJson(const Repeatability& repeat);

std::string assessmentTable(const CalibrationCheck& check);
std::string assessmentTable(const Maintenance& maintenance);
std::string assessmentTable(const Repeatability& repeat);

std::string ofSensor(const std::string& sensor, const std::string& against);  // "rear against front"
std::string shownUnit(const std::string& unit);                               // "" of "1"

// A sentence without its full stop.
std::string windowsText(const CheckedWindows& windows);

// Separate tables: stops of all IMUs, one per line; a track over time; each number of a repeat with its
// sigmas.
std::string stopsCsv(const Maintenance& maintenance);
std::string trackCsv(const MaintenanceTrack& track);
std::string repeatCsv(const Repeatability& repeat);
std::string columnOf(const TrackedQuantity& quantity, const TrackedNumber& number);  // "rotation.x [deg]"

}  // namespace evical

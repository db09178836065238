// Arguments that commands share: SESSION -o DIR [--set group.option=value ...] [--threads N] [--quiet] of
// calibrate and detect; RESULT.
#pragma once

#include "core/data/recording.h"
#include "core/pipeline/session/session.h"
#include "core/report/result_yaml.h"

#include <string>
#include <vector>

namespace evical {

class Command;

struct SessionArguments {
  std::string session, output;
  std::vector<std::string> settings;
  int threads = 0;  // 0: from the options
  bool quiet = false;
  std::string detections;  // for calibrate: folder of an earlier run with detections; empty: detect again
  std::string profile;     // for calibrate: file of the profile; empty: none
};

void addSessionArguments(Command& command, SessionArguments& arguments);

// Applies each group.option=value to the session.
void applySettings(const std::vector<std::string>& settings, Session& session);

// The session with the settings applied.
Session sessionFrom(const SessionArguments& arguments);

// Result of a calibration or a truth, by its file or folder. Warns if the folder's run data do not belong to
// it.
NamedResult resultAt(const std::string& path);
void warnOfForeignRunData(const std::string& path);

// The same command with the option that repairs its result.
std::string tryText(const SessionArguments& arguments, const Repair& repair);

// One folder per camera, for files that have the same names.
std::vector<std::string> foldersOfCameras(const Session& session);

// "346x260". Throws CalibrationError (BadInput).
Resolution resolutionIn(const std::string& text);

void printFaults(const std::vector<RecordingFault>& faults);

}  // namespace evical

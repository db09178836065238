// Arguments that calibrate and detect share: SESSION -o DIR [--set
// group.option=value ...] [--threads N] [--quiet].
#pragma once

#include "core/pipeline/session/session.h"

#include <string>
#include <vector>

namespace evical {

class Command;

struct SessionArguments {
  std::string session, output;
  std::vector<std::string> settings;
  int threads = 0;  // 0: as the options say
  bool quiet = false;
  std::string
      detections;       // of calibrate: a folder of an earlier run to start from; empty: from the recording
  std::string profile;  // of calibrate: a file for where its time goes; empty: none
};

void addSessionArguments(Command& command, SessionArguments& arguments);

// Each group.option=value into the session.
void applySettings(const std::vector<std::string>& settings, Session& session);

// The session with the settings applied.
Session sessionFrom(const SessionArguments& arguments);

// The same command with what mends its result.
std::string tryText(const SessionArguments& arguments, const Repair& repair);

}  // namespace evical

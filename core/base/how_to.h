// Instructions whose wording depends on the front end: a message of core never names a command, a flag or a
// page directly.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace evical {

enum class HowTo {
  Inspect,              // "Check the recording ..."
  LookAtDetections,     // "Look at what is seen ..."
  CalibrateLens,        // "Calibrate the camera ..."
  MakeFlashingPage,     // "A page that flashes is made ..."
  SayThatBoardFlashes,  // "If it flashes, ..."
  EditBoard,            // "Check rows and columns ..."
  EditSession,          // "Correct these two ..."
  MakeSession,          // "Give a session: ..."
  GiveResolution,       // "..."
  NameSeparateStreams,  // gyroscope's and accelerometer's stream
  NameLogOfImu,         // IMU, stream or log
  SetAccelerationUnit,  // unit
  SetAngularRateUnit,   // unit
  CalibrateEach,        // "Give several recordings ..."
  LimitTime,            // name of the setting: "no samples in ..."
  UseDetections,        // name of the setting: "leave ... out"
  Option,               // name of an argument
};
constexpr int kHowTos = static_cast<int>(HowTo::Option) + 1;

// Text of one instruction, with %1 and %2 for its arguments.
using HowToWords = const char* (*)(HowTo way);
const char* commandLineWords(HowTo way);

// Sets the front end's texts. Called once at start-up; the default is the command line's.
void speakWith(HowToWords words);

// The instruction for this program's front end, for displayed errors. Texts that are saved in files must not
// depend on it.
std::string howTo(HowTo way, std::initializer_list<std::string_view> parts = {});

}  // namespace evical

// What each front end has its own words for: a message of core names the way, never a command, an option flag or a page.
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
  LimitTime,            // the name of the setting: "no samples in ..."
  UseDetections,        // the name of the setting: "leave ... out"
  Option,               // the name of an argument
};
constexpr int kHowTos = static_cast<int>(HowTo::Option) + 1;

// With %1 and %2 where the parts belong.
using HowToWords = const char* (*)(HowTo way);
const char* commandLineWords(HowTo way);

// Once, when a program begins; until then it is the command line that speaks.
void speakWith(HowToWords words);

// In the words of this program's front end: for errors, which are shown. What is kept in files suits all of them.
std::string howTo(HowTo way, std::initializer_list<std::string_view> parts = {});

}  // namespace evical

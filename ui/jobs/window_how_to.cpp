// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/window_how_to.h"

namespace evical::ui {

const char* windowHowTo(HowTo way) {
  switch (way) {
    case HowTo::Inspect:
    case HowTo::EditSession:
      return "on the Recording page";
    case HowTo::EditBoard:
      return "in the Board form";
    case HowTo::LookAtDetections:
      return "on the Detection page";
    case HowTo::CalibrateLens:
      return "alone";
    case HowTo::MakeFlashingPage:
      return "with 'Print a board'";
    case HowTo::SayThatBoardFlashes:
      return "tick 'The board flashes' in the Board form";
    case HowTo::MakeSession:
      return "Open the recording instead";
    case HowTo::GiveResolution:
      return "Give its resolution in the camera's form on the Recording page";
    case HowTo::NameSeparateStreams:
      return "Choose the role IMU for both streams on the Recording page, gyroscope: %1 and accelerometer: "
             "%2";
    case HowTo::NameLogOfImu:
      return "%1=%2 under Streams";
    case HowTo::SetAccelerationUnit:
      return "%1 as accelerometer unit";
    case HowTo::SetAngularRateUnit:
      return "%1 as gyroscope unit";
    case HowTo::CalibrateEach:
      return "to the page Several recordings";
    case HowTo::LimitTime:
      return "the time range";
    case HowTo::UseDetections:
      return "the old detections";
    case HowTo::Option:
      return "the option %1";
  }
  return "";
}

}  // namespace evical::ui

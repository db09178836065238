#include "core/base/how_to.h"

#include <atomic>

namespace evical {
namespace {

std::atomic<HowToWords> words_of_front_end = commandLineWords;

}  // namespace

const char* commandLineWords(HowTo way) {
  switch (way) {
    case HowTo::Inspect:
      return "with 'evical inspect'";
    case HowTo::LookAtDetections:
      return "with 'evical detect --images'";
    case HowTo::CalibrateLens:
      return "with 'evical intrinsics'";
    case HowTo::MakeFlashingPage:
      return "with 'evical board --blink'";
    case HowTo::SayThatBoardFlashes:
      return "set blinking: true for the session's board";
    case HowTo::EditBoard:
    case HowTo::EditSession:
      return "in the session";
    case HowTo::MakeSession:
      return "Make one with `evical init RECORDING`, `evical simulate` or `evical import`";
    case HowTo::GiveResolution:
      return "Give resolution_px: [width, height] for this camera in the session";
    case HowTo::NameSeparateStreams:
      return "Replace the key stream of this IMU in the session by gyroscope: %1 and accelerometer: %2";
    case HowTo::NameLogOfImu:
      return "--imu %1=%2";
    case HowTo::SetAccelerationUnit:
      return "--acceleration-unit %1";
    case HowTo::SetAngularRateUnit:
      return "--angular-rate-unit %1";
    case HowTo::CalibrateEach:
      return "to 'evical repeat'";
    case HowTo::LimitTime:
      return "time_range_s";
    case HowTo::UseDetections:
      return "--detections";
    case HowTo::Option:
      return "--%1";
  }
  return "";
}

void speakWith(HowToWords words) {
  words_of_front_end = words;
}

std::string howTo(HowTo way, std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const char* at = words_of_front_end.load()(way); *at != '\0'; ++at) {
    if (*at != '%')
      text += *at;
    else
      text += parts.begin()[*++at - '1'];
  }
  return text;
}

}  // namespace evical

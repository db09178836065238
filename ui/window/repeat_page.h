// SPDX-License-Identifier: GPL-3.0-or-later
// The page of several recordings: its job, where its results go, and how one of them is opened.
#pragma once

namespace evical::ui {

class RepeatScreen;
class SessionFiles;
struct Workbench;

void wireRepeat(RepeatScreen& screen, Workbench& workbench, SessionFiles& files);

}  // namespace evical::ui

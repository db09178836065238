// SPDX-License-Identifier: GPL-3.0-or-later
// The page that holds an old result against a new recording: its job, what is proposed to it, its files.
#pragma once

namespace evical::ui {

class ResultCheckScreen;
class SessionFiles;
struct Workbench;

void wireResultCheck(ResultCheckScreen& screen, Workbench& workbench, SessionFiles& files);

}  // namespace evical::ui

# To be sourced: a display without a screen, in separate folders. Needs `scratch`, a folder; stopDisplay ends
# all programs that are started here.

# WIDTHxHEIGHT
startDisplay() {
  Xvfb -displayfd 3 -screen 0 "$1x24" -nolisten tcp 3>"$scratch/display" 2>/dev/null &
  display_pid=$!
  for _ in $(seq 100); do [ -s "$scratch/display" ] && break; sleep 0.1; done
  export DISPLAY=":$(cat "$scratch/display")" QT_QPA_PLATFORM=xcb XDG_CONFIG_HOME="$scratch" XDG_DATA_HOME="$scratch"
}

# Openbox shows, moves and focuses its windows.
startWindowManager() {
  export HOME="$scratch"
  openbox 2>/dev/null &
  manager_pid=$!
  # It is ready as soon as the root window names the window manager.
  for _ in $(seq 100); do
    xdotool get_desktop >/dev/null 2>&1 && break
    sleep 0.1
  done
}

stopDisplay() {
  kill "${manager_pid:-}" "${display_pid:-}" 2>/dev/null || true
  wait 2>/dev/null || true
}

# SPDX-License-Identifier: Apache-2.0

# Sets PELLUCID_ON_DISPLAY to what a command that draws in windows stands behind: a server of X of
# its own. It is empty where xvfb-run is not installed (Debian: xvfb xauth).
find_program(PELLUCID_XVFB_RUN NAMES xvfb-run)
mark_as_advanced(PELLUCID_XVFB_RUN)
set(PELLUCID_ON_DISPLAY)
if(PELLUCID_XVFB_RUN)
  # Without -noreset the server starts anew when its last client leaves, and refuses those who come
  # meanwhile: a program's second window, or another rank.
  set(PELLUCID_ON_DISPLAY
    "${PELLUCID_XVFB_RUN}" -a -s "-screen 0 1280x1024x24 -nolisten tcp -noreset")
endif()

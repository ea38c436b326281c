# Writes the test groups of PROGRAM as ctest entries into OUT. Groups that drive a simulated robot in real time run alone:
# on two cores a neighbour that computes would stall them.
cmake_minimum_required(VERSION 3.25)
set(REAL_TIME CreateRobot StandingRobot RemoteGuard Accessory Guard CreatePty SimSource Kinect ClosedLoopRun Serve)
execute_process(COMMAND ${PROGRAM} -lg OUTPUT_VARIABLE groups COMMAND_ERROR_IS_FATAL ANY)
string(STRIP "${groups}" groups)
string(REPLACE " " ";" groups "${groups}")
set(entries "")
# How soon a robot stands says nothing where a sanitizer slows every process, and writes a report before it lets one die.
if(SANITIZED)
  list(REMOVE_ITEM groups StandingRobot)
endif()
foreach(group IN LISTS groups)
  string(APPEND entries "add_test(unit.${group} \"${PROGRAM}\" -sg ${group})\n")
  if(group IN_LIST REAL_TIME)
    string(APPEND entries "set_tests_properties(unit.${group} PROPERTIES RUN_SERIAL TRUE)\n")
  endif()
endforeach()
file(WRITE ${OUT} "${entries}")

# Writes what the program makes of the options of the planner and of its experiments:
#   cmake --build build/release --target write_generated
# PROGRAM is graspfit, PYTHON the interpreter, SOURCE_DIR the sources. Tests compare the files.
function(write_output file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} WORKING_DIRECTORY ${SOURCE_DIR}
    OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${SOURCE_DIR}/${file}.new "${text}")
  file(RENAME ${SOURCE_DIR}/${file}.new ${SOURCE_DIR}/${file})
endfunction()

write_output(docs/options.md options)
write_output(grasp/grasps.schema.json options --schema grasp/grasps.schema.json)
write_output(experiments/config.schema.json experiment schema)
execute_process(
  COMMAND ${PYTHON} -B ${SOURCE_DIR}/tests/repository/check_readings.py ${SOURCE_DIR} --write
  COMMAND_ERROR_IS_FATAL ANY)

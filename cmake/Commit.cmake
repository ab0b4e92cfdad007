# cmake -DSOURCE=dir -DOUTPUT=commit.h -P Commit.cmake: the commit that is being built, at each build; the
# file is written only when it changes.
execute_process(COMMAND git describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#pragma once\n#define LODBENCH_COMMIT \"${commit}\"\n" @ONLY)

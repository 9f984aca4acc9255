# Runs hello_cloth in a folder of its own and wants its picture.
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND ${PROGRAM} --headless WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "hello_cloth ended with ${result}")
endif()
file(SIZE ${FOLDER}/hello_cloth.png size)
if(size LESS 50000) # a picture of one colour is far smaller
    message(FATAL_ERROR "hello_cloth.png has ${size} bytes only")
endif()

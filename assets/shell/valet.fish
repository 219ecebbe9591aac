# Asks the program itself, so that the completions are always those of the installed version.
valet shell --completions fish | source

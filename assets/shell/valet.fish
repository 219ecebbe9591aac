# Print an optspec for argparse to handle cmd's options that are independent of any subcommand.
function __fish_valet_global_optspecs
    string join \n h/help V/version
end

function __fish_valet_needs_command
    # Figure out if the current invocation already has a command.
    set -l cmd (commandline -opc)
    set -e cmd[1]
    argparse -s (__fish_valet_global_optspecs) -- $cmd 2>/dev/null
    or return
    if set -q argv[1]
        # Also print the command, so this can be used to figure out what it is.
        echo $argv[1]
        return 1
    end
    return 0
end

function __fish_valet_using_subcommand
    set -l cmd (__fish_valet_needs_command)
    test -z "$cmd"
    and return 1
    contains -- $cmd[1] $argv
end

complete -c valet -n "__fish_valet_needs_command" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c valet -n "__fish_valet_needs_command" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_needs_command" -f -a "demo" -d 'The whole thing with a simulated robot and person (the default)'
complete -c valet -n "__fish_valet_needs_command" -f -a "console" -d 'The operator console on a ROS graph'
complete -c valet -n "__fish_valet_needs_command" -f -a "sim" -d 'The simulated Baxter, person and camera as a ROS node'
complete -c valet -n "__fish_valet_needs_command" -f -a "doctor" -d 'The checklist before a trial: each line with age, value and what to do'
complete -c valet -n "__fish_valet_needs_command" -f -a "fit" -d 'Fits a person\'s movement space from recorded joints'
complete -c valet -n "__fish_valet_needs_command" -f -a "train" -d 'Trains a forest that finds body parts in depth images'
complete -c valet -n "__fish_valet_needs_command" -f -a "label" -d 'Labels depth images by the colours of a person\'s clothes'
complete -c valet -n "__fish_valet_needs_command" -f -a "reproduce" -d 'The thesis\' tables and figures beside the thesis\' own numbers'
complete -c valet -n "__fish_valet_needs_command" -f -a "torture" -d 'Simulated trials with faults, in virtual time, with every invariant checked'
complete -c valet -n "__fish_valet_needs_command" -f -a "bench" -d 'Speeds that matter to a user'
complete -c valet -n "__fish_valet_needs_command" -f -a "replay" -d 'A recorded trial through the same core, on the same screen: every decision compared with the recorded one'
complete -c valet -n "__fish_valet_needs_command" -f -a "report" -d 'Recorded trials as self-contained HTML pages with SVG and PNG plots'
complete -c valet -n "__fish_valet_needs_command" -f -a "export" -d 'A recorded trial as a rosbag or CSV files'
complete -c valet -n "__fish_valet_needs_command" -f -a "profile" -d 'A person\'s profile: check, show, encrypt, forget'
complete -c valet -n "__fish_valet_needs_command" -f -a "config" -d 'The configuration: print the default one, check a file'
complete -c valet -n "__fish_valet_needs_command" -f -a "keys" -d 'The table of keys'
complete -c valet -n "__fish_valet_needs_command" -f -a "shell" -d 'Man page and shell completions, for packagers'
complete -c valet -n "__fish_valet_needs_command" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c valet -n "__fish_valet_using_subcommand demo" -l seed -d 'Seed of everything random; it is printed and recorded' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l profile -d 'The person: a name or a file' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l strategy -d 'The strategy that the trial begins with' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l garment -d 'The model of the garment' -r -f -a "reduced\t'A tube round the movement that the person likes best: fast, smooth, calibrated to the thesis\' table 4.2'
cloth\t'An armhole of cloth round a moving arm: believable, a core\'s work of its own'"
complete -c valet -n "__fish_valet_using_subcommand demo" -l garment-name -d 'The garment, by its name in the profile; the first one there where none is named' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l exercise -d 'For so many seconds the person moves both arms about first, as before a first trial: something to record' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l fault -d 'Something that goes wrong, any number of times: KIND[=VALUE]@SECONDS[+SECONDS][:SIDE], as in `stale_force@20+3:right`' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l fault-seed -d 'One more fault, drawn from this seed' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l trials -d 'How many trials to run, with consecutive seeds' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l record -d 'Record into this folder instead of the one of this user (`$XDG_DATA_HOME/valet/trials`, the demo\'s in `demos`)' -r -F
complete -c valet -n "__fish_valet_using_subcommand demo" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand demo" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand demo" -l theme -d 'The colours of the screen' -r -f -a "terminal\t''
high-contrast\t''
mono\t''
okabe-ito\t''"
complete -c valet -n "__fish_valet_using_subcommand demo" -l color -d 'Whether colours are used at all' -r -f -a "auto\t''
always\t''
never\t''"
complete -c valet -n "__fish_valet_using_subcommand demo" -l fps -d 'Frames a second at the most; 10 is right for a slow ssh line' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l port -d 'The port of the simulator\'s master; the program sets it for itself when it begins anew' -r
complete -c valet -n "__fish_valet_using_subcommand demo" -l headless -d 'Run without a screen: virtual time, one process, done in seconds'
complete -c valet -n "__fish_valet_using_subcommand demo" -l ros -d 'With --headless: take the way over TCPROS, in real time'
complete -c valet -n "__fish_valet_using_subcommand demo" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand demo" -l no-record -d 'Record nothing. What is not recorded cannot be shown, replayed or explained afterwards'
complete -c valet -n "__fish_valet_using_subcommand demo" -l ascii -d 'Draw with ASCII alone'
complete -c valet -n "__fish_valet_using_subcommand demo" -l warm-start -d 'Begin with the paths that earlier trials of this person learned'
complete -c valet -n "__fish_valet_using_subcommand demo" -l hold-to-run -d 'The arms move only as long as the run key is held down, as in the first trial with a person'
complete -c valet -n "__fish_valet_using_subcommand demo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c valet -n "__fish_valet_using_subcommand demo" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand console" -l profile -d 'The person: a name or a file' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l garment -d 'The garment, by its name in the profile; the first one there where none is named' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l strategy -d 'The strategy that a trial begins with' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l planner -d 'Who plans the straight lines: `built_in` or `moveit`' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l seed -d 'Seed of everything random; it is recorded [default: 1]' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l config -d 'Another file of settings than the one that is found' -r -F
complete -c valet -n "__fish_valet_using_subcommand console" -l record -d 'Record into this folder instead of the one of this user (`$XDG_DATA_HOME/valet/trials`, the demo\'s in `demos`)' -r -F
complete -c valet -n "__fish_valet_using_subcommand console" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand console" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand console" -l theme -d 'The colours of the screen' -r -f -a "terminal\t''
high-contrast\t''
mono\t''
okabe-ito\t''"
complete -c valet -n "__fish_valet_using_subcommand console" -l color -d 'Whether colours are used at all' -r -f -a "auto\t''
always\t''
never\t''"
complete -c valet -n "__fish_valet_using_subcommand console" -l fps -d 'Frames a second at the most; 10 is right for a slow ssh line' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l pose-from -d 'Take the person\'s pose from this recorded trial, at its pace, instead of a camera or a tracker' -r -F
complete -c valet -n "__fish_valet_using_subcommand console" -l watch -d 'Show the trial of a node that runs already: this screen can stop it and do nothing else' -r
complete -c valet -n "__fish_valet_using_subcommand console" -l no-record -d 'Record nothing. What is not recorded cannot be shown, replayed or explained afterwards'
complete -c valet -n "__fish_valet_using_subcommand console" -l ascii -d 'Draw with ASCII alone'
complete -c valet -n "__fish_valet_using_subcommand console" -l warm-start -d 'Begin with the paths that earlier trials of this person learned'
complete -c valet -n "__fish_valet_using_subcommand console" -l hold-to-run -d 'The arms move only as long as the run key is held down, as in the first trial with a person'
complete -c valet -n "__fish_valet_using_subcommand console" -l dry-run -d 'Decide everything, command nothing'
complete -c valet -n "__fish_valet_using_subcommand console" -l headless -d 'Without a screen: print what happens as lines, read commands as lines (`enable`, `start`, `stop`, ...)'
complete -c valet -n "__fish_valet_using_subcommand console" -l json -d 'With --headless: print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand console" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c valet -n "__fish_valet_using_subcommand console" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand sim" -l master -d 'Where the ROS master comes from' -r -f -a "running\t'One that runs already, where `ROS_MASTER_URI` says'
embedded\t'One inside this process'"
complete -c valet -n "__fish_valet_using_subcommand sim" -l port -d 'With --master embedded: the port that it listens on, on this machine only' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l profile -d 'The person: a name or a file' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l seed -d 'Seed of everything random [default: 1]' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l garment -d 'The model of the garment' -r -f -a "reduced\t'A tube round the movement that the person likes best: fast, smooth, calibrated to the thesis\' table 4.2'
cloth\t'An armhole of cloth round a moving arm: believable, a core\'s work of its own'"
complete -c valet -n "__fish_valet_using_subcommand sim" -l skeleton -d 'What the skeleton tracker publishes on /tf' -r -f -a "steady\t'All joints, always: a camera that nothing stands before'
occluded\t'Joints that the robot\'s grippers hide from the camera are no longer published: their frames go stale'
none\t'No tracker runs: the person\'s pose must come from depth images'"
complete -c valet -n "__fish_valet_using_subcommand sim" -l garment-name -d 'The garment, by its name in the profile; the first one there where none is named' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l exercise -d 'For so many seconds the person moves both arms about first, as before a first trial: something to record' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l fault -d 'Something that goes wrong, any number of times: KIND[=VALUE]@SECONDS[+SECONDS][:SIDE], as in `stale_force@20+3:right`' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l fault-seed -d 'One more fault, drawn from this seed' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l images -d 'Instead of a robot: write depth images of simulated people with their truth into this folder' -r -F
complete -c valet -n "__fish_valet_using_subcommand sim" -l count -d 'With --images: how many' -r
complete -c valet -n "__fish_valet_using_subcommand sim" -l until-input-ends -d 'End when the standard input does: whoever started this simulator is gone then'
complete -c valet -n "__fish_valet_using_subcommand sim" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c valet -n "__fish_valet_using_subcommand sim" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand doctor" -l seconds -d 'For how long to listen, in seconds' -r
complete -c valet -n "__fish_valet_using_subcommand doctor" -l planner -d 'Also ask this planner for a short line of each arm, without moving: `built_in` or `moveit`' -r
complete -c valet -n "__fish_valet_using_subcommand doctor" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand doctor" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand doctor" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand fit" -l out -d 'Where the movement space is written (TOML); only reported where it is not given' -r -F
complete -c valet -n "__fish_valet_using_subcommand fit" -l most-components -d 'Most Gaussians a joint' -r
complete -c valet -n "__fish_valet_using_subcommand fit" -l floor -d 'Smallest standard deviation in any direction, in metres' -r
complete -c valet -n "__fish_valet_using_subcommand fit" -l seed -d 'Seed of the starting points' -r
complete -c valet -n "__fish_valet_using_subcommand fit" -l json -d 'Print one JSON object a joint on stdout'
complete -c valet -n "__fish_valet_using_subcommand fit" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand fit" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand train" -l out -d 'The file that the forest is written to' -r -F
complete -c valet -n "__fish_valet_using_subcommand train" -l from -d 'Folder with own images: NAME.png (16-bit, millimetres), NAME.json (`fx`, `fy`, `cx`, `cy`, `neck_m`) and truth/NAME.png (8-bit labels); empty/NAME.png and truth/joints.jsonl are used where they are there. Without it people are simulated' -r -F
complete -c valet -n "__fish_valet_using_subcommand train" -l images -d 'Images; of a folder, at most so many' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l trees -d 'Trees; without it 1, and 3 for a generic forest' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l depth -d 'Deepest level of a leaf' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l pixels -d 'Pixels of each part of an image' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l features -d 'Features that a node tries' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l thresholds -d 'Thresholds for each feature' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l neck-share -d 'Share of a node\'s features that look at the way and the place from the neck; 0 is the thesis\' equation 3.1 alone' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l seed -d 'Seed of everything random, the simulated people too' -r
complete -c valet -n "__fish_valet_using_subcommand train" -l generic -d 'Train on many simulated people instead of one, for people whom nobody has trained for'
complete -c valet -n "__fish_valet_using_subcommand train" -l json -d 'Print one JSON object a tree, and one at the end, on stdout'
complete -c valet -n "__fish_valet_using_subcommand train" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand train" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand label" -l images -d 'Folder with NAME.png (16-bit grey, millimetres), NAME.json (`fx`, `fy`, `cx`, `cy`, `neck_m`) and colour/NAME.png (8-bit colour, registered to the depth image); empty/NAME.png is used where it is there' -r -F
complete -c valet -n "__fish_valet_using_subcommand label" -l samples -d 'TOML file with the colour of each part: `[left]` and `[right]` with `shoulder`, `upper_arm`, `forearm` and `hand`, each `[red, green, blue]` from 0 to 255, or `{ image = "NAME.png", column = 320, row = 240 }` to pick it from colour/NAME.png' -r -F
complete -c valet -n "__fish_valet_using_subcommand label" -l profile -d 'The person whose profile holds the colours (`[clothes.left]`, `[clothes.right]`): a name or a file' -r
complete -c valet -n "__fish_valet_using_subcommand label" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand label" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand label" -l out -d 'Folder for the label images (8-bit, 255 is no part); without it truth/ in the folder of the images' -r -F
complete -c valet -n "__fish_valet_using_subcommand label" -l json -d 'One JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand label" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand label" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand reproduce" -l out -d 'Folder for CSV files, plots (SVG and PNG) and the page; made where it does not exist' -r -F
complete -c valet -n "__fish_valet_using_subcommand reproduce" -l seed -d 'Seed of everything random' -r
complete -c valet -n "__fish_valet_using_subcommand reproduce" -l json -d 'Print one JSON object a row on stdout'
complete -c valet -n "__fish_valet_using_subcommand reproduce" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand reproduce" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand torture" -l minutes -d 'Stop after so many minutes of real time' -r
complete -c valet -n "__fish_valet_using_subcommand torture" -l trials -d 'Stop after so many trials. Without --minutes and --trials: 1000 trials' -r
complete -c valet -n "__fish_valet_using_subcommand torture" -l seed -d 'Seed of the first trial; the others follow. A failing seed is repeated by `--seed SEED --trials 1`' -r
complete -c valet -n "__fish_valet_using_subcommand torture" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand torture" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand torture" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -f -a "console" -d 'The console: frames, stop latency, processor time, bytes to the terminal, memory'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -f -a "ik" -d 'Inverse kinematics: how many poses are solved, and how fast'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -f -a "motion" -d 'Straight lines: how many an arm can follow, how exactly, and what checks, plans and halts cost'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -f -a "pose" -d 'Joints in a folder of depth images: label images, places and times'
complete -c valet -n "__fish_valet_using_subcommand bench; and not __fish_seen_subcommand_from console ik motion pose help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -l frames -d 'Frames of each screen' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -l stops -d 'How often the robot is stopped: by the key, and by a force over the hard cap' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -l seconds -d 'For how many seconds each load is measured' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -l soak -d 'For how many seconds memory is watched at full rate (75 s of warm-up come before)' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -l port -d 'The port of the master; the program sets it for itself when it begins anew' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -l json -d 'One JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from console" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from ik" -l side -d 'Whose arm' -r -f -a "left\t''
right\t''"
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from ik" -l targets -d 'Poses of the gripper\'s tip in the robot\'s base frame, one a row: px,py,pz,qx,qy,qz,qw (m). Without it, 10,000 poses are made from uniform joint samples' -r -F
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from ik" -l seed -d 'Seed of the poses that are made without a file' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from ik" -l json -d 'One JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from ik" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from ik" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from motion" -l side -d 'Whose arm follows the lines; the other one is out of the way' -r -f -a "left\t''
right\t''"
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from motion" -l lines -d 'Random lines of 0.25 to 0.6 m at fixed orientation in front of the robot' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from motion" -l seed -d 'Seed of the lines and configurations' -r
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from motion" -l json -d 'One JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from motion" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from motion" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -l images -d 'Folder with NAME.png (16-bit grey, millimetres) and NAME.json (fx, fy, cx, cy in pixels; `neck_m` as [x, y, z] in the camera frame)' -r -F
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -l empty -d 'Folder with the empty scene of each image: NAME.png, or one image for all' -r -F
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -l out -d 'Folder for label images (8-bit, 255 is no part) and joints.jsonl; made where it does not exist' -r -F
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -l forest -d 'The forest to use; without it, the one that valet brings along' -r -F
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -l facing -d 'Which way the person faces in images whose NAME.json does not say so with `facing`' -r -f -a "lower-edge\t'Towards the lower edge: the camera is above or ahead of the person'
upper-edge\t'Towards the upper edge: the camera is behind the person, as on the robot\'s head'"
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -l json -d 'One JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from pose" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from help" -f -a "console" -d 'The console: frames, stop latency, processor time, bytes to the terminal, memory'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from help" -f -a "ik" -d 'Inverse kinematics: how many poses are solved, and how fast'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from help" -f -a "motion" -d 'Straight lines: how many an arm can follow, how exactly, and what checks, plans and halts cost'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from help" -f -a "pose" -d 'Joints in a folder of depth images: label images, places and times'
complete -c valet -n "__fish_valet_using_subcommand bench; and __fish_seen_subcommand_from help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c valet -n "__fish_valet_using_subcommand replay" -l what-if -d 'Change a setting and show what would have been decided, as in `strategy=multimodal` or `window.threshold_newtons=4`' -r
complete -c valet -n "__fish_valet_using_subcommand replay" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand replay" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand replay" -l check -d 'Only compare: exit code 0 only where every decision is the recorded one and the whole journal could be read'
complete -c valet -n "__fish_valet_using_subcommand replay" -l headless -d 'Print what was decided as lines instead of showing it on a screen'
complete -c valet -n "__fish_valet_using_subcommand replay" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand replay" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c valet -n "__fish_valet_using_subcommand replay" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand report" -l out -d 'The folder to write into' -r -F
complete -c valet -n "__fish_valet_using_subcommand report" -l answers -d 'The answers to the questionnaires of one trial; without it they are looked for beside each trial, in `NAME.answers.toml`' -r -F
complete -c valet -n "__fish_valet_using_subcommand report" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand report" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand report" -l print-answers -d 'Print a file of answers to be filled in, and do nothing else'
complete -c valet -n "__fish_valet_using_subcommand report" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand report" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand report" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand export" -l format -d '`bag` (rosbag 2.0, one file) or `csv` (a folder of tables)' -r -f -a "bag\t''
csv\t''"
complete -c valet -n "__fish_valet_using_subcommand export" -l out -d 'The file or folder to write; beside the trial where it is not given' -r -F
complete -c valet -n "__fish_valet_using_subcommand export" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand export" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand export" -l anonymous -d 'Leave out free text and absolute time'
complete -c valet -n "__fish_valet_using_subcommand export" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand export" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand export" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "list" -d 'The profiles that can be found'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "check" -d 'Check a profile; every mistake is named with file and key'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "show" -d 'Show a profile in words'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "learn" -d 'Write what a recorded trial has learned into its person\'s profile, for the next trial to begin with'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "encrypt" -d 'Encrypt a profile\'s file or a recorded trial; the plain file is removed'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "decrypt" -d 'Decrypt a profile\'s file or a recorded trial; the encrypted file is removed'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "export" -d 'Print a profile without free text and dates'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "forget" -d 'Erase a person\'s profile and trials, and print a receipt'
complete -c valet -n "__fish_valet_using_subcommand profile; and not __fish_seen_subcommand_from list check show learn encrypt decrypt export forget help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from list" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from list" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from check" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from check" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from check" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from check" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from show" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from show" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from show" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from show" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from learn" -l profile -d 'Name or file; the person of the trial where it is not given' -r
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from learn" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from learn" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from learn" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from learn" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from encrypt" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from encrypt" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from encrypt" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from encrypt" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from decrypt" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from decrypt" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from decrypt" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from decrypt" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from export" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from export" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from export" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from export" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -l trials -d 'A folder of trials; may be given more than once. The default ones where it is not given' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -l key -d 'A file with the age key of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -l passphrase-file -d 'A file whose first line is the passphrase of an encrypted profile' -r -F
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -l yes -d 'Really erase. Without it, only what would be erased is listed'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -l json -d 'Print one JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from forget" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "list" -d 'The profiles that can be found'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "check" -d 'Check a profile; every mistake is named with file and key'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "show" -d 'Show a profile in words'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "learn" -d 'Write what a recorded trial has learned into its person\'s profile, for the next trial to begin with'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "encrypt" -d 'Encrypt a profile\'s file or a recorded trial; the plain file is removed'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "decrypt" -d 'Decrypt a profile\'s file or a recorded trial; the encrypted file is removed'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "export" -d 'Print a profile without free text and dates'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "forget" -d 'Erase a person\'s profile and trials, and print a receipt'
complete -c valet -n "__fish_valet_using_subcommand profile; and __fish_seen_subcommand_from help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c valet -n "__fish_valet_using_subcommand config" -l check -d 'Check a file of settings (the one that would be used, where none is named) and the profile that it names' -r -F
complete -c valet -n "__fish_valet_using_subcommand config" -l print-default -d 'Print the default settings as a file'
complete -c valet -n "__fish_valet_using_subcommand config" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand config" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand keys" -l list -d 'Print the table (this is what the command does; the option says it plainly in scripts)'
complete -c valet -n "__fish_valet_using_subcommand keys" -l json -d 'One JSON object a line'
complete -c valet -n "__fish_valet_using_subcommand keys" -l practise -d 'Practise the keys at a made-up trial that is connected to nothing'
complete -c valet -n "__fish_valet_using_subcommand keys" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand keys" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand shell" -l completions -d 'Print the completions of this shell' -r -f -a "bash\t''
elvish\t''
fish\t''
powershell\t''
zsh\t''"
complete -c valet -n "__fish_valet_using_subcommand shell" -l out -d 'Write the man pages and the completions of all shells into this folder instead' -r -F
complete -c valet -n "__fish_valet_using_subcommand shell" -l man -d 'Print the man page'
complete -c valet -n "__fish_valet_using_subcommand shell" -s h -l help -d 'Print help'
complete -c valet -n "__fish_valet_using_subcommand shell" -s V -l version -d 'Print version'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "demo" -d 'The whole thing with a simulated robot and person (the default)'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "console" -d 'The operator console on a ROS graph'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "sim" -d 'The simulated Baxter, person and camera as a ROS node'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "doctor" -d 'The checklist before a trial: each line with age, value and what to do'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "fit" -d 'Fits a person\'s movement space from recorded joints'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "train" -d 'Trains a forest that finds body parts in depth images'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "label" -d 'Labels depth images by the colours of a person\'s clothes'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "reproduce" -d 'The thesis\' tables and figures beside the thesis\' own numbers'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "torture" -d 'Simulated trials with faults, in virtual time, with every invariant checked'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "bench" -d 'Speeds that matter to a user'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "replay" -d 'A recorded trial through the same core, on the same screen: every decision compared with the recorded one'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "report" -d 'Recorded trials as self-contained HTML pages with SVG and PNG plots'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "export" -d 'A recorded trial as a rosbag or CSV files'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "profile" -d 'A person\'s profile: check, show, encrypt, forget'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "config" -d 'The configuration: print the default one, check a file'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "keys" -d 'The table of keys'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "shell" -d 'Man page and shell completions, for packagers'
complete -c valet -n "__fish_valet_using_subcommand help; and not __fish_seen_subcommand_from demo console sim doctor fit train label reproduce torture bench replay report export profile config keys shell help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from bench" -f -a "console" -d 'The console: frames, stop latency, processor time, bytes to the terminal, memory'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from bench" -f -a "ik" -d 'Inverse kinematics: how many poses are solved, and how fast'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from bench" -f -a "motion" -d 'Straight lines: how many an arm can follow, how exactly, and what checks, plans and halts cost'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from bench" -f -a "pose" -d 'Joints in a folder of depth images: label images, places and times'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "list" -d 'The profiles that can be found'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "check" -d 'Check a profile; every mistake is named with file and key'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "show" -d 'Show a profile in words'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "learn" -d 'Write what a recorded trial has learned into its person\'s profile, for the next trial to begin with'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "encrypt" -d 'Encrypt a profile\'s file or a recorded trial; the plain file is removed'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "decrypt" -d 'Decrypt a profile\'s file or a recorded trial; the encrypted file is removed'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "export" -d 'Print a profile without free text and dates'
complete -c valet -n "__fish_valet_using_subcommand help; and __fish_seen_subcommand_from profile" -f -a "forget" -d 'Erase a person\'s profile and trials, and print a receipt'

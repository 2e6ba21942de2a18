import subprocess
import sys
from collections.abc import Callable
from types import ModuleType

import cloudpickle

ELSEWHERE = """
import pickle, sys
from mjdrive.errors import UnknownNameError
work, job = pickle.load(sys.stdin.buffer)
try:
    work.begin()(job, lambda done: None)
except UnknownNameError as error:
    print(error)
"""


def test_the_work_is_done_by_a_process_that_knows_nothing_of_the_script(
    load_script: Callable[[str], ModuleType],
) -> None:
    script = load_script("check_experts")
    cloudpickle.register_pickle_by_value(script)  # as clusters send what lives in `__main__`
    try:
        sent = cloudpickle.dumps(
            (script.Checking(), script.Job("pid", "default", "atlantis", "one", 0))
        )
    finally:
        cloudpickle.unregister_pickle_by_value(script)
    done = subprocess.run(
        [sys.executable, "-c", ELSEWHERE], input=sent, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr.decode()
    assert done.stdout.startswith(b"Unknown town 'atlantis'")

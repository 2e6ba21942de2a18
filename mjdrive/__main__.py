"""`python -m mjdrive` is `mjdrive`."""

from mjdrive.cli.main import main

main(prog_name="mjdrive")

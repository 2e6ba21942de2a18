"""The simulation as other people's tools expect it: Gymnasium, dm_env, and MuJoCo's viewer."""

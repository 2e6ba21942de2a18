"""Pure learning: tensors in, tensors out. Nothing here knows of towns, cars or simulators."""

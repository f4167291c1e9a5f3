"""One page about a model: analyses chosen by what the model has, their numbers, pictures, errors and run times."""

"""Other people's codes and our models: error and time of every scene, with numbers in use and with ours."""

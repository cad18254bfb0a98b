etalonHistory("news",[]);
